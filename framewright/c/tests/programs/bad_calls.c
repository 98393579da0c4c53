/* Calls that are wrong: each has its status and its words, and the handles go on. Needs a folder to write in. */

#include <framewright.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures;

static void expect(int line, FramewrightStatus status, FramewrightStatus wanted, const char *words) {
    const char *said = wanted == FRAMEWRIGHT_STATUS_OK ? "" : framewright_last_error();
    if (status != wanted || strstr(said, words) == NULL) {
        fprintf(stderr, "line %d: status %d, and not %d with `%s`: %s\n", line, status, wanted, words, framewright_last_error());
        ++failures;
    }
}

#define FINE(call) expect(__LINE__, call, FRAMEWRIGHT_STATUS_OK, "")
#define WRONG(call, status, words) expect(__LINE__, call, FRAMEWRIGHT_STATUS_##status, words)
#define HOLDS(condition) expect(__LINE__, (condition) ? FRAMEWRIGHT_STATUS_OK : FRAMEWRIGHT_STATUS_PANIC, FRAMEWRIGHT_STATUS_OK, "")

static void ignore(void *context, const char *text) {
    (void)context;
    (void)text;
}

static void write_file(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    fputs(text, file);
    fclose(file);
}

/* Counts that were never set, or that count something else. */
static const size_t too_many[] = {SIZE_MAX, SIZE_MAX / 2, SIZE_MAX / 8, UINT32_MAX, 1u << 20};
#define COUNTS (sizeof too_many / sizeof *too_many)

static void counts(FramewrightRenderer *renderer) {
    FramewrightChoice choice = {.name = "screen"};
    FramewrightSemaphore semaphore = {.value = 1};
    VkImage image = VK_NULL_HANDLE;
    for (size_t i = 0; i < COUNTS; ++i) {
        FramewrightSubmission images = {.struct_size = sizeof images, .images = &choice, .image_count = too_many[i]};
        WRONG(framewright_renderer_submit(renderer, &images, NULL), MISUSE, "`images` has ");
        FramewrightSubmission waits = {.struct_size = sizeof waits, .waits = &semaphore, .wait_count = too_many[i]};
        WRONG(framewright_renderer_submit(renderer, &waits, NULL), MISUSE, "`waits` has ");
        FramewrightSubmission signals = {.struct_size = sizeof signals, .signals = &semaphore, .signal_count = too_many[i]};
        WRONG(framewright_renderer_submit(renderer, &signals, NULL), MISUSE, "`signals` has ");
        WRONG(framewright_renderer_import_images(renderer, "screen", &image, too_many[i]), MISUSE, "`images` has ");
    }
    WRONG(framewright_renderer_set_facts(renderer, (const FramewrightFacts *)1), MISUSE, "`facts` is no pointer");
}

static void devices(FramewrightDevice **device) {
    FramewrightDevice *none = (FramewrightDevice *)device;
    WRONG(framewright_device_open(NULL, NULL), MISUSE, "`device` is NULL");
    FramewrightDeviceOptions options = {.struct_size = sizeof options, .name = "no such device"};
    WRONG(framewright_device_open(&options, &none), MACHINE, "no device named no such device");
    HOLDS(none == NULL);
    options.name = "\xff";
    WRONG(framewright_device_open(&options, &none), MISUSE, "`name` is no UTF-8: its byte 0 is wrong");
    options.struct_size = 8;
    WRONG(framewright_device_open(&options, &none), MISUSE, "sizeof(FramewrightDeviceOptions)");
    WRONG(framewright_device_adopt(NULL, &none), MISUSE, "`program` is NULL");
    FramewrightAdoptedDevice program = {.struct_size = sizeof program};
    WRONG(framewright_device_adopt(&program, &none), MISUSE, "`instance` of `program` is NULL");
    /* Handles that nothing is asked of. */
    FramewrightQueue queues[] = {{0, (VkQueue)device}, {0, VK_NULL_HANDLE}};
    program.instance = (VkInstance)device;
    program.physical_device = (VkPhysicalDevice)device;
    program.device = (VkDevice)device;
    program.queues = queues;
    for (size_t i = 0; i < COUNTS; ++i) {
        program.queue_count = too_many[i];
        WRONG(framewright_device_adopt(&program, &none), MISUSE, "`queues` has ");
    }
    program.queue_count = 2;
    WRONG(framewright_device_adopt(&program, &none), MISUSE, "`queues[1].queue` of `program` is NULL");
    WRONG(framewright_device_findings(NULL, ignore, NULL), MISUSE, "`device` is NULL");
    HOLDS(framewright_device_name(NULL) == NULL);
    framewright_device_free(NULL);

    FINE(framewright_device_open(NULL, device));
    WRONG(framewright_device_findings(*device, NULL, NULL), MISUSE, "`tell` is NULL");
    FINE(framewright_device_findings(*device, ignore, NULL));
}

static void scenes(FramewrightScene **scene) {
    WRONG(framewright_scene_load(NULL, scene), MISUSE, "`path` is NULL");
    HOLDS(*scene == NULL);
    WRONG(framewright_scene_load("no such scene", scene), FILE, "there is no scene `no such scene`");
    write_file("scene.ron", "Scene(\n    version: 1,\n    camra: (),\n)\n");
    WRONG(framewright_scene_load("scene.ron", scene), MISTAKES, "scene.ron:3:5");
    framewright_scene_free(NULL);
    HOLDS(framewright_scene_mistake(NULL, 0) == NULL);
    write_file("wrong.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"mesh\": 4}]}");
    FINE(framewright_scene_load("wrong.gltf", scene));
    HOLDS(strstr(framewright_scene_mistake(*scene, 0), "node 0: refers to mesh 4") != NULL);
    HOLDS(strstr(framewright_scene_mistake(*scene, 1), "there is nothing to draw") != NULL);
    HOLDS(framewright_scene_mistake(*scene, 2) == NULL && framewright_scene_mistake(*scene, SIZE_MAX) == NULL);
    framewright_scene_free(*scene);
    FINE(framewright_scene_load("spheres_and_cubes", scene));
}

static void pipelines(const FramewrightDevice *device) {
    FramewrightRenderer *renderer;
    WRONG(framewright_renderer_open(NULL, "forward", NULL, &renderer), MISUSE, "`device` is NULL");
    WRONG(framewright_renderer_open(device, NULL, NULL, &renderer), MISUSE, "`pipeline` is NULL");
    WRONG(framewright_renderer_open(device, "forward", NULL, NULL), MISUSE, "`renderer` is NULL");
    WRONG(framewright_renderer_open(device, "forwards", NULL, &renderer), FILE, "there is no pipeline `forwards`");
    HOLDS(renderer == NULL && framewright_last_mistake(0) == NULL);
    FramewrightRendererOptions options = {.struct_size = 1};
    WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "sizeof(FramewrightRendererOptions)");
    options.struct_size = sizeof options;
    options.shaders.count = 1;
    WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "`shaders` is NULL");
    const char *name = "a";
    const FramewrightNames none = {0};
    for (size_t i = 0; i < COUNTS; ++i) {
        const FramewrightNames many = {.names = &name, .count = too_many[i]};
        options.shaders = many;
        WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "`shaders` has ");
        options.shaders = none;
        options.settings = many;
        WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "`settings` has ");
        options.settings = none;
        options.extensions = many;
        WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "`extensions` has ");
        options.extensions = none;
        options.shader_compilers = many;
        WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "`shader_compilers` has ");
        options.shader_compilers = none;
    }
    options.shader_compilers = (FramewrightNames){.names = &name, .count = 1};
    WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "`a` names no compiler");

    /* A compiler that the program names is the one that is run. */
    write_file("post.wgsl", "@fragment fn tinted() -> @location(0) vec4f { return vec4f(1.0); }\n");
    write_file("wgsl.ron",
               "Pipeline(version: 1, images: [(name: \"screen\", format: Output, size: Output)], passes: [\n"
               "    (name: \"post\", draw: FullScreen(\"post.wgsl:tinted\"), color: [\"screen\"]),\n], outputs: [\"screen\"])\n");
    const char *commands[] = {NULL, "wgsl=no-such-compiler {input} {output}"};
    const char *said[] = {"no compiler of WGSL is named", "its compiler `no-such-compiler` isn't there"};
    for (size_t i = 0; i < 2; ++i) {
        options.shader_compilers = (FramewrightNames){.names = &commands[i], .count = i};
        FINE(framewright_renderer_open(device, "wgsl.ron", &options, &renderer));
        FINE(framewright_renderer_set_extent(renderer, 64, 36));
        WRONG(framewright_renderer_frame(renderer, NULL), MACHINE, said[i]);
        HOLDS(strcmp(framewright_last_mistake(0)->code, "E1310") == 0);
        framewright_renderer_free(renderer);
    }
    options.shader_compilers = none;
    options.frames_in_flight = UINT32_MAX;
    WRONG(framewright_renderer_open(device, "forward", &options, &renderer), MISUSE, "at most 16 may be on their way");

    write_file("mine.ron", "Pipeline(\n    version: 1,\n    extends: \"forwards.ron\",\n)\n");
    WRONG(framewright_renderer_open(device, "mine.ron", NULL, &renderer), MISTAKES, "mine.ron:3:14");
    const FramewrightMistake *mistake = framewright_last_mistake(0);
    HOLDS(mistake != NULL && strcmp(mistake->file, "mine.ron") == 0 && mistake->line == 3 && mistake->column == 14);
    HOLDS(mistake->message[0] != 0 && strcmp(mistake->code, "E0501") == 0 && framewright_last_mistake(1) == NULL);
}

static void renderers(FramewrightRenderer *renderer, const FramewrightScene *scene) {
    WRONG(framewright_renderer_set(NULL, "msaa", "4"), MISUSE, "`renderer` is NULL");
    WRONG(framewright_renderer_set(renderer, NULL, "4"), MISUSE, "`setting` is NULL");
    WRONG(framewright_renderer_set(renderer, "msaa", "3"), MISTAKES, "`msaa`");
    WRONG(framewright_renderer_set(renderer, "masa", "4"), MISTAKES, "there is no setting named `masa`");
    WRONG(framewright_renderer_set_preset(renderer, "best"), MISTAKES, "`best`");
    WRONG(framewright_renderer_set_extent(renderer, 0, 1), MISTAKES, "the frame can't be 0");
    WRONG(framewright_renderer_set_stereo(renderer, 5), MISUSE, "there is no `stereo` of the number 5");
    WRONG(framewright_renderer_set_rotation(renderer, 4), MISUSE, "there is no `rotation` of the number 4");
    FramewrightFacts facts = {.struct_size = 4};
    WRONG(framewright_renderer_set_facts(renderer, &facts), MISUSE, "sizeof(FramewrightFacts)");
    facts.struct_size = sizeof facts;
    const double odd[] = {NAN, -NAN, INFINITY, -INFINITY, -1.0};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; ++i) {
        facts.peak_radiance = odd[i];
        WRONG(framewright_renderer_set_facts(renderer, &facts), MISUSE, "`peak_radiance` is ");
        facts.peak_radiance = 1.0;
        facts.depth_range = odd[i];
        WRONG(framewright_renderer_set_facts(renderer, &facts), MISUSE, "`depth_range` is ");
        facts.depth_range = 0.0;
        facts.size = odd[i];
        WRONG(framewright_renderer_set_facts(renderer, &facts), MISUSE, "`size` is ");
        facts.size = 0.0;
    }
    /* The largest of everything is fine. */
    memset(&facts, 0xff, sizeof facts);
    facts.struct_size = sizeof facts;
    facts.peak_radiance = facts.depth_range = facts.size = 1e308;
    FINE(framewright_renderer_set_facts(renderer, &facts));
    FINE(framewright_renderer_set_facts(renderer, NULL));
    counts(renderer);

    FramewrightTexels texels;
    WRONG(framewright_renderer_read(renderer, "screen", &texels), MISUSE, "there is none yet");
    FINE(framewright_renderer_set_extent(renderer, 64, 36));
    WRONG(framewright_renderer_frame(renderer, NULL), MISTAKES, "draws a scene, and none was set");
    FINE(framewright_renderer_set_scene(renderer, scene));
    FINE(framewright_renderer_set(renderer, "msaa", "1"));
    FramewrightChange change = FRAMEWRIGHT_CHANGE_NOTHING;
    FINE(framewright_renderer_prepare(renderer, &change));
    HOLDS(change == FRAMEWRIGHT_CHANGE_PLAN);
    FINE(framewright_renderer_prepare(renderer, &change));
    HOLDS(change == FRAMEWRIGHT_CHANGE_NOTHING);

    uint64_t frame;
    WRONG(framewright_renderer_wait(renderer, 7), MISUSE, "frame 7");
    WRONG(framewright_renderer_record_into(renderer, NULL, NULL, NULL, 0, NULL), MISUSE, "`done` is NULL");
    FramewrightSemaphore done = {.value = 1};
    WRONG(framewright_renderer_record_into(renderer, NULL, &done, NULL, 0, NULL), MISUSE, "is NULL");
    FramewrightChoice choice = {.name = "screen", .image = 3};
    FramewrightSubmission among = {.struct_size = sizeof among, .images = &choice, .image_count = 1};
    WRONG(framewright_renderer_submit(renderer, &among, &frame), MISUSE, "`screen` has no image 3");
    choice.name = NULL;
    WRONG(framewright_renderer_submit(renderer, &among, &frame), MISUSE, "`name` is NULL");
    choice.name = "screen";
    choice.image = 0;
    FramewrightSemaphore null = {.value = 1};
    among.waits = &null;
    among.wait_count = 1;
    WRONG(framewright_renderer_submit(renderer, &among, &frame), MISUSE, "a semaphore of `waits` is NULL");
    among.wait_count = 0;
    among.signals = &null;
    among.signal_count = 1;
    WRONG(framewright_renderer_submit(renderer, &among, &frame), MISUSE, "a semaphore of `signals` is NULL");
    VkImageCreateInfo info;
    WRONG(framewright_renderer_image_info(renderer, "color", &info), MISUSE, "there is no external image `color`");
    WRONG(framewright_renderer_image_info(renderer, "screen", NULL), MISUSE, "`info` is NULL");
    FINE(framewright_renderer_image_info(renderer, "screen", &info));
    HOLDS(info.extent.width == 64 && info.extent.height == 36 && info.format == VK_FORMAT_R8G8B8A8_SRGB);
    WRONG(framewright_renderer_states(renderer, "scren", NULL, NULL), MISUSE, "there is no external image `scren`");
    VkImage image = VK_NULL_HANDLE;
    WRONG(framewright_renderer_import_images(renderer, "screen", &image, 1), MISUSE, "NULL");
    WRONG(framewright_renderer_import_images(renderer, "screen", NULL, 0), MISUSE, "no images were given");
    WRONG(framewright_renderer_image(renderer, "scren", &image), MISUSE, "there is no image `scren`");

    /* All goes on, in several frames, with numbers that count through. */
    for (uint64_t number = 0; number < 3; ++number) {
        FINE(framewright_renderer_submit(renderer, NULL, &frame));
        HOLDS(frame == number);
        FINE(framewright_renderer_set(renderer, "msaa", number == 0 ? "4" : NULL));
    }
    FINE(framewright_renderer_wait(renderer, frame));
    WRONG(framewright_renderer_read(renderer, "scren", &texels), MISUSE, "there is no output `scren`");
    WRONG(framewright_renderer_read(renderer, "screen", NULL), MISUSE, "`texels` is NULL");
    FINE(framewright_renderer_read(renderer, "screen", &texels));
    HOLDS(texels.width == 64 && texels.height == 36 && texels.byte_count == 64 * 36 * 4);
    FINE(framewright_renderer_image(renderer, "screen", &image));
    HOLDS(image != VK_NULL_HANDLE);
}

/* `show` and what follows share a rendering scope; `dot` has one of another format. */
static const char CUSTOM[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"mine\", format: R8G8B8A8_UNORM, size: Output), (name: \"screen\", format: R8G8B8A8_SRGB, size: Output)],\n"
    "    buffers: [(name: \"numbers\", bytes: 64)],\n"
    "    passes: [(name: \"whole\", custom: \"fill\", writes: [\"mine\", \"numbers\"]),\n"
    "        (name: \"dot\", custom: \"dot\", color: [\"mine\"]),\n"
    "        (name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"mine\"}, color: [\"screen\"]),\n"
    "        (name: \"corner\", custom: \"mark\", color: [\"screen\"]),\n"
    "        (name: \"things\", draw: Objects(Opaque), shader: \"placed\", color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";

/* What the callback is given. */
typedef struct {
    FramewrightRenderer *renderer;
    /* The pass that draws, by what is called `custom`. */
    const char *drawn;
    int calls;
} Program;

/* Wrong calls about a pass. */
static uint32_t record(void *context, const FramewrightPass *pass) {
    Program *program = context;
    ++program->calls;
    const char *own = pass->in_scope && strcmp(pass->custom, "dot") != 0 ? "screen" : "mine";
    FramewrightPassImage image;
    VkBuffer buffer;
    FINE(framewright_pass_image(pass, own, &image));
    WRONG(framewright_pass_image(NULL, own, &image), MISUSE, "`pass` is NULL");
    WRONG(framewright_pass_image((const FramewrightPass *)1, own, &image), MISUSE, "`pass` is no pointer");
    WRONG(framewright_pass_image(pass, NULL, &image), MISUSE, "`name` is NULL");
    WRONG(framewright_pass_image(pass, "\xff", &image), MISUSE, "`name` is no UTF-8");
    WRONG(framewright_pass_image(pass, "scren", &image), MISUSE, "the pass accesses no image `scren`");
    WRONG(framewright_pass_image(pass, own, NULL), MISUSE, "`image` is NULL");
    WRONG(framewright_pass_buffer(NULL, "numbers", &buffer), MISUSE, "`pass` is NULL");
    WRONG(framewright_pass_buffer(pass, NULL, &buffer), MISUSE, "`name` is NULL");
    WRONG(framewright_pass_buffer(pass, own, &buffer), MISUSE, "the pass accesses no buffer `");
    if (!pass->in_scope) {
        FINE(framewright_pass_buffer(pass, "numbers", &buffer));
        WRONG(framewright_pass_buffer(pass, "numbers", NULL), MISUSE, "`buffer` is NULL");
        WRONG(framewright_pass_draw(pass, 0, 3, 0, 1), MISUSE, "the pass stands outside of rendering scopes");
    }
    if (pass->inheritance != NULL) {
        WRONG(framewright_pass_draw(pass, 0, 3, 0, 1), MISUSE, "the draws of the pass come in secondary command buffers");
    }
    WRONG(framewright_pass_draw(NULL, 0, 3, 0, 1), MISUSE, "`pass` is NULL");
    WRONG(framewright_pass_draw(pass, UINT32_MAX, 1, 0, 1), MISUSE, "too many vertices");
    WRONG(framewright_pass_draw(pass, 0, 3, 1, UINT32_MAX), MISUSE, "too many instances");
    /* One that the program made itself. */
    const FramewrightPass made = {.name = "whole"};
    WRONG(framewright_pass_image(&made, own, &image), MISUSE, "`pass->resources` is NULL");
    WRONG(framewright_pass_buffer(&made, "numbers", &buffer), MISUSE, "`pass->resources` is NULL");
    WRONG(framewright_pass_draw(&made, 0, 3, 0, 1), MISUSE, "`pass->resources` is NULL");
    /* The renderer is in the middle of a call. */
    FramewrightFormats formats;
    VkCommandBufferInheritanceRenderingInfo told;
    uint32_t stereo;
    WRONG(framewright_renderer_formats(program->renderer, "corner", &formats), MISUSE, "the renderer is in use");
    WRONG(framewright_renderer_inheritance(program->renderer, "corner", &told), MISUSE, "the renderer is in use");
    WRONG(framewright_renderer_both_eyes(program->renderer, "corner", &stereo, NULL), MISUSE, "the renderer is in use");
    WRONG(framewright_renderer_set_secondary(program->renderer, "mark", 1), MISUSE, "the renderer is in use");
    if (strcmp(pass->custom, program->drawn) == 0) {
        FINE(framewright_pass_draw(pass, 0, 3, 0, 1));
    }
    return 1;
}

/* What is told of passes before the frame, and what is set for them. */
static void told(FramewrightRenderer *renderer) {
    FramewrightFormats formats;
    VkCommandBufferInheritanceRenderingInfo corner, dot;
    FramewrightEyeForm form;
    uint32_t stereo;
    WRONG(framewright_renderer_formats(NULL, "corner", &formats), MISUSE, "`renderer` is NULL");
    WRONG(framewright_renderer_formats(renderer, NULL, &formats), MISUSE, "`pass` is NULL");
    WRONG(framewright_renderer_formats(renderer, "corner", NULL), MISUSE, "`formats` is NULL");
    WRONG(framewright_renderer_formats(renderer, "whole", &formats), MISUSE, "no rendering scope has a pass of the name `whole`");
    WRONG(framewright_renderer_inheritance(NULL, "corner", &corner), MISUSE, "`renderer` is NULL");
    WRONG(framewright_renderer_inheritance(renderer, NULL, &corner), MISUSE, "`pass` is NULL");
    WRONG(framewright_renderer_inheritance(renderer, "corner", NULL), MISUSE, "`inheritance` is NULL");
    WRONG(framewright_renderer_inheritance(renderer, "cornr", &corner), MISUSE, "no rendering scope has a pass of the name `cornr`");
    WRONG(framewright_renderer_both_eyes(NULL, "corner", &stereo, &form), MISUSE, "`renderer` is NULL");
    WRONG(framewright_renderer_both_eyes(renderer, NULL, &stereo, &form), MISUSE, "`pass` is NULL");
    WRONG(framewright_renderer_both_eyes(renderer, "corner", NULL, &form), MISUSE, "`stereo` is NULL");
    FINE(framewright_renderer_both_eyes(renderer, "corner", &stereo, NULL));
    HOLDS(stereo == FRAMEWRIGHT_STEREO_OFF && form == FRAMEWRIGHT_EYE_FORM_NONE);
    WRONG(framewright_renderer_set_secondary(NULL, "mark", 1), MISUSE, "`renderer` is NULL");
    WRONG(framewright_renderer_set_secondary(renderer, NULL, 1), MISUSE, "`custom` is NULL");
    WRONG(framewright_renderer_set_secondary(renderer, "\xff", 1), MISUSE, "`custom` is no UTF-8");
    WRONG(framewright_renderer_set_recorder(NULL, record, NULL), MISUSE, "`renderer` is NULL");

    /* What was told of one pass outlives what is told of another one, and of the same one again. */
    FINE(framewright_renderer_inheritance(renderer, "corner", &corner));
    FINE(framewright_renderer_inheritance(renderer, "dot", &dot));
    FINE(framewright_renderer_formats(renderer, "dot", &formats));
    FINE(framewright_renderer_formats(renderer, "corner", &formats));
    HOLDS(corner.colorAttachmentCount == 1 && corner.pColorAttachmentFormats[0] == VK_FORMAT_R8G8B8A8_SRGB);
    HOLDS(dot.colorAttachmentCount == 1 && dot.pColorAttachmentFormats[0] == VK_FORMAT_R8G8B8A8_UNORM);
    HOLDS(formats.color == corner.pColorAttachmentFormats && formats.color_count == 1);
}

static void custom_passes(const FramewrightDevice *device) {
    write_file("custom.ron", CUSTOM);
    write_file("placed.vert",
               "#version 460\nlayout(location = 0) in vec3 position;\nvoid main() { gl_Position = vec4(position, 1.0); }\n");
    write_file("placed.frag", "#version 460\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(1.0); }\n");
    FramewrightRenderer *renderer;
    FINE(framewright_renderer_open(device, "custom.ron", NULL, &renderer));
    FINE(framewright_renderer_set_extent(renderer, 64, 36));
    told(renderer);
    WRONG(framewright_renderer_frame(renderer, NULL), MISTAKES, "no recorder was set");
    Program program = {.renderer = renderer, .drawn = ""};
    FINE(framewright_renderer_set_recorder(renderer, record, &program));
    FINE(framewright_renderer_frame(renderer, NULL));
    HOLDS(program.calls == 4);
    FINE(framewright_renderer_set_secondary(renderer, "mark", 1));
    FINE(framewright_renderer_frame(renderer, NULL));
    FINE(framewright_renderer_set_secondary(renderer, "mark", 0));
    /* Draws that can't be are errors of the frame, and the next one is fine. */
    program.drawn = "placed";
    WRONG(framewright_renderer_frame(renderer, NULL), MISUSE, "a draw without vertex buffer");
    program.drawn = "mark";
    WRONG(framewright_renderer_frame(renderer, NULL), MISUSE, "there is no shader `mark`");
    program.drawn = "";
    FINE(framewright_renderer_frame(renderer, NULL));
    FINE(framewright_renderer_set_recorder(renderer, NULL, &program));
    WRONG(framewright_renderer_frame(renderer, NULL), MISTAKES, "no recorder was set");
    framewright_renderer_free(renderer);
}

/* A page that can't be served, or isn't one. */
static void viewers(FramewrightRenderer *renderer) {
    FramewrightViewer *viewer = (FramewrightViewer *)renderer;
    const char *url = NULL;
    WRONG(framewright_viewer_serve(NULL, &viewer), MISUSE, "`address` is NULL");
    HOLDS(viewer == NULL);
    WRONG(framewright_viewer_serve("127.0.0.1:0", NULL), MISUSE, "`viewer` is NULL");
    WRONG(framewright_viewer_serve("nowhere", &viewer), MISUSE, "no page can be served at `nowhere`");
    /* An address of documentation, which no machine has. */
    WRONG(framewright_viewer_serve("192.0.2.1:7117", &viewer), MACHINE, "no page can be served at `192.0.2.1:7117`");
    WRONG(framewright_viewer_frame(NULL, renderer), MISUSE, "`viewer` is NULL");
    WRONG(framewright_viewer_url(NULL, &url), MISUSE, "`viewer` is NULL");
    FINE(framewright_viewer_serve("127.0.0.1:0", &viewer));
    WRONG(framewright_viewer_frame(viewer, NULL), MISUSE, "`renderer` is NULL");
    WRONG(framewright_viewer_url(viewer, NULL), MISUSE, "`url` is NULL");
    FINE(framewright_viewer_url(viewer, &url));
    HOLDS(strncmp(url, "http://127.0.0.1:", 17) == 0);
    FINE(framewright_viewer_frame(viewer, renderer));
    framewright_viewer_free(viewer);
    framewright_viewer_free(NULL);
}

int main(void) {
    HOLDS(framewright_abi() == FRAMEWRIGHT_ABI && framewright_version()[0] != 0 && framewright_last_error()[0] == 0);
    FramewrightDevice *device;
    devices(&device);
    FramewrightScene *scene;
    scenes(&scene);
    pipelines(device);
    custom_passes(device);
    FramewrightRenderer *renderer;
    FINE(framewright_renderer_open(device, "forward", NULL, &renderer));
    /* What was made from a handle outlives it. */
    framewright_device_free(device);
    renderers(renderer, scene);
    viewers(renderer);
    framewright_scene_free(scene);
    FINE(framewright_renderer_frame(renderer, NULL));
    framewright_renderer_free(renderer);
    framewright_renderer_free(NULL);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
