/* A program in C records for both eyes at once: a pass that fills images, one within a rendering scope, and draws of objects of its own by a
 * shader of the pipeline's. In each way that the device knows, each eye sees what it sees by one eye after the other. */

#include "testing.h"

static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"mine\", format: R8G8B8A8_UNORM, size: Output, per_eye: true),\n"
    "        (name: \"screen\", format: R8G8B8A8_UNORM, size: Like(\"mine\"))],\n"
    "    passes: [(name: \"whole\", custom: \"fill\", both_eyes: true, writes: [\"mine\"],\n"
    "        uses: [(image: \"mine\", stages: [CLEAR], accesses: [TRANSFER_WRITE], layout: GENERAL)]),\n"
    "        (name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"mine\"}, color: [\"screen\"]),\n"
    "        (name: \"corner\", custom: \"mark\", both_eyes: true, sample: {\"seen\": \"mine\"}, color: [\"screen\"]),\n"
    "        (name: \"things\", draw: Objects(Opaque), shader: \"thing\", color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";

/* A triangle over the lower left half. */
static const char VERTICES[] =
    "#version 460\n"
    "void main() { gl_Position = vec4(gl_VertexIndex == 2 ? 1.0 : -1.0, gl_VertexIndex == 0 ? -1.0 : 1.0, 0.0, 1.0); }\n";
/* Red for the left eye, green for the right one. */
static const char COLOR[] =
    "#version 460\n"
    "#extension GL_GOOGLE_include_directive : require\n"
    "#include \"include/stereo.glsl\"\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() { color = eye_index == 0 ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 1.0, 0.0, 1.0); }\n";

enum { WIDTH = 64, HEIGHT = 32 };

static void expect(int holds, const char *what) {
    if (!holds) {
        fprintf(stderr, "%s\n", what);
        exit(EXIT_FAILURE);
    }
}

/* What a callback is given. */
typedef struct {
    uint32_t stereo;
    FramewrightEyeForm form;
    int calls;
} Program;

static const char *name_of(const char *image, FramewrightEye eye) {
    static char name[64];
    const char *const eyes[] = {"", " (left)", " (right)"};
    snprintf(name, sizeof name, "%s%s", image, eyes[eye]);
    return name;
}

static uint32_t record(void *context, const FramewrightPass *pass) {
    Program *program = context;
    ++program->calls;
    int at_once = program->stereo != FRAMEWRIGHT_STEREO_MULTI_PASS;
    expect(pass->both_eyes == (at_once ? program->stereo : (uint32_t)FRAMEWRIGHT_STEREO_OFF), "another way");
    expect((pass->eye == FRAMEWRIGHT_EYE_NONE) == at_once, "another eye");
    expect(pass->eye_form == program->form, "another form");
    if (strcmp(pass->custom, "fill") == 0) {
        expect(!pass->in_scope && pass->formats == NULL, "it is outside of a scope");
        expect(framewright_pass_draw(pass, 0, 3, 0, 1) == FRAMEWRIGHT_STATUS_MISUSE, "it draws outside of a scope");
        FramewrightPassImage image;
        check(framewright_pass_image(pass, name_of("mine", pass->eye), &image));
        expect(image.eye_form == program->form && image.eye == FRAMEWRIGHT_EYE_NONE, "another image");
        expect(image.width == WIDTH && image.height == HEIGHT, "sides are those of one eye's picture");
        expect(image.range.layerCount == (image.eye_form == FRAMEWRIGHT_EYE_FORM_LAYERS ? 2u : 1u), "other layers");
        VkClearColorValue blue = {.float32 = {0, 0, 1, 1}};
        vkCmdClearColorImage(pass->commands, image.image, image.layout, &blue, 1, &image.range);
        return 1;
    }
    if (pass->draw == FRAMEWRIGHT_DRAW_OPAQUE) {
        expect(strcmp(pass->custom, "thing") == 0 && strncmp(pass->name, "things", 6) == 0, "another shader");
        check(framewright_pass_draw(pass, 0, 3, 0, 1));
        return 1;
    }
    expect(pass->draw == FRAMEWRIGHT_DRAW_CUSTOM && pass->in_scope, "it is within a scope");
    expect(pass->width == WIDTH && pass->height == HEIGHT, "sides are those of one eye's picture");
    expect(pass->formats->color_count == 1 && pass->formats->color[0] == VK_FORMAT_R8G8B8A8_UNORM, "another format");
    expect(pass->formats->view_mask == (program->stereo == FRAMEWRIGHT_STEREO_MULTIVIEW ? 3u : 0u), "another mask");
    FramewrightPassImage image;
    check(framewright_pass_image(pass, "seen", &image));
    expect(image.eye_form == program->form, "another image");
    VkClearAttachment white = {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = {.float32 = {1, 1, 1, 1}}}};
    if (!at_once || pass->formats->view_mask != 0) {
        /* The device clears each view. */
        VkClearRect corner = {{{0, 0}, {WIDTH / 2, HEIGHT / 2}}, 0, 1};
        vkCmdClearAttachments(pass->commands, 1, &white, 1, &corner);
        return 1;
    }
    for (int eye = 0; eye < 2; ++eye) {
        const FramewrightEyeTarget *target = &pass->eye_targets[eye];
        expect(target->viewport.width == WIDTH && target->scissor.extent.width == WIDTH, "another viewport");
        VkClearRect corner = {{target->scissor.offset, {WIDTH / 2, HEIGHT / 2}}, target->layer, 1};
        vkCmdClearAttachments(pass->commands, 1, &white, 1, &corner);
    }
    return 1;
}

/* The texel of an eye's picture as a number. */
static uint32_t texel(const uint8_t *bytes, FramewrightEyeForm form, int eye, int x, int y) {
    int at = y * WIDTH + x;
    if (form == FRAMEWRIGHT_EYE_FORM_LAYERS) {
        at += eye * WIDTH * HEIGHT;
    } else if (form == FRAMEWRIGHT_EYE_FORM_HALVES) {
        at = (2 * y + eye) * WIDTH + x;
    }
    uint32_t word;
    memcpy(&word, bytes + 4 * at, 4);
    return word;
}

static void count(void *findings, const char *text) {
    fprintf(stderr, "%s\n", text);
    ++*(size_t *)findings;
}

int main(void) {
    write_file("eyes.ron", PIPELINE);
    write_file("thing.vert", VERTICES);
    write_file("thing.frag", COLOR);
    FramewrightDeviceOptions options = {.struct_size = sizeof options, .validation = 1};
    FramewrightDevice *device;
    check(framewright_device_open(&options, &device));
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(device, "eyes.ron", NULL, &renderer));
    check(framewright_renderer_set_extent(renderer, WIDTH, HEIGHT));
    Program program;
    check(framewright_renderer_set_recorder(renderer, record, &program));
    static uint32_t alone[2][HEIGHT][WIDTH];
    int ways = 0;
    for (uint32_t stereo = FRAMEWRIGHT_STEREO_MULTI_PASS; stereo <= FRAMEWRIGHT_STEREO_MULTIVIEW; ++stereo) {
        int at_once = stereo != FRAMEWRIGHT_STEREO_MULTI_PASS;
        FramewrightStatus set = framewright_renderer_set_stereo(renderer, stereo);
        if (set == FRAMEWRIGHT_STATUS_MACHINE) {
            continue;
        }
        check(set);
        uint32_t known;
        FramewrightFormats formats;
        program = (Program){.stereo = stereo};
        check(framewright_renderer_both_eyes(renderer, at_once ? "whole" : "whole (left)", &known, &program.form));
        expect(known == (at_once ? stereo : (uint32_t)FRAMEWRIGHT_STEREO_OFF), "another way is told");
        check(framewright_renderer_formats(renderer, at_once ? "corner" : "corner (left)", &formats));
        expect(formats.color_count == 1 && formats.samples == VK_SAMPLE_COUNT_1_BIT, "other formats are told");
        expect(framewright_renderer_formats(renderer, "whole", &formats) == FRAMEWRIGHT_STATUS_MISUSE, "no scope");
        check(framewright_renderer_frame(renderer, NULL));
        expect(program.calls == (at_once ? 3 : 6), "passes are recorded once for both eyes");
        for (int eye = 0; eye < 2; ++eye) {
            FramewrightTexels texels;
            const char *name = at_once ? "screen" : name_of("screen", (FramewrightEye)(1 + eye));
            check(framewright_renderer_read(renderer, name, &texels));
            for (int y = 0; y < HEIGHT; ++y) {
                for (int x = 0; x < WIDTH; ++x) {
                    uint32_t found = texel(texels.bytes, program.form, eye, x, y);
                    if (!at_once) {
                        alone[eye][y][x] = found;
                    }
                    expect(found == alone[eye][y][x], "an eye sees something else");
                }
            }
        }
        ++ways;
    }
    /* Blue, white in a corner, and half of it in the eye's own colour. */
    expect(alone[0][1][WIDTH - 1] == 0xffff0000 && alone[0][1][10] == 0xffffffff, "what was recorded isn't seen");
    expect(alone[0][HEIGHT - 1][1] == 0xff0000ff && alone[1][HEIGHT - 1][1] == 0xff00ff00, "eyes see the same");
    size_t findings = 0;
    check(framewright_device_findings(device, count, &findings));
    framewright_renderer_free(renderer);
    framewright_device_free(device);
    printf("%d ways\n", ways);
    return ways >= 2 && findings == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
