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

int main(void) {
    HOLDS(framewright_abi() == FRAMEWRIGHT_ABI && framewright_version()[0] != 0 && framewright_last_error()[0] == 0);
    FramewrightDevice *device;
    devices(&device);
    FramewrightScene *scene;
    scenes(&scene);
    pipelines(device);
    FramewrightRenderer *renderer;
    FINE(framewright_renderer_open(device, "forward", NULL, &renderer));
    /* What was made from a handle outlives it. */
    framewright_device_free(device);
    renderers(renderer, scene);
    framewright_scene_free(scene);
    FINE(framewright_renderer_frame(renderer, NULL));
    framewright_renderer_free(renderer);
    framewright_renderer_free(NULL);
    return failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
