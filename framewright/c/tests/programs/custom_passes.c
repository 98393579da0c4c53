/* Custom passes that a program in C records: one that fills an image, and one within a rendering scope. Writes picture.ppm. */

#include "testing.h"

static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"mine\", format: Color(hdr: false), size: Output), (name: \"screen\", format: Output, size: Output)],\n"
    "    passes: [(name: \"whole\", custom: \"fill\", writes: [\"mine\"],\n"
    "        uses: [(image: \"mine\", stages: [CLEAR], accesses: [TRANSFER_WRITE], layout: GENERAL)]),\n"
    "        (name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"mine\"}, color: [\"screen\"]),\n"
    "        (name: \"corner\", custom: \"mark\", color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";

/* What a callback is given. */
typedef struct {
    FramewrightRenderer *renderer;
    int knows_marks;
    int calls;
    uint32_t family;
} Program;

static uint32_t record(void *context, const FramewrightPass *pass) {
    Program *program = context;
    ++program->calls;
    FAILS(framewright_renderer_wait(program->renderer, 0), MISUSE, "the renderer is in use");
    FramewrightPassImage image;
    if (strcmp(pass->custom, "fill") == 0 && strcmp(pass->name, "whole") == 0 && !pass->in_scope) {
        VkBuffer buffer;
        FAILS(framewright_pass_image(pass, "screen", &image), MISUSE, "accesses no image `screen`");
        FAILS(framewright_pass_buffer(pass, "mine", &buffer), MISUSE, "accesses no buffer `mine`");
        check(framewright_pass_image(pass, "mine", &image));
        program->family = pass->queue_family;
        if (image.layout != VK_IMAGE_LAYOUT_GENERAL) {
            return 0;
        }
        VkClearColorValue blue = {.float32 = {0, 0, 1, 1}};
        vkCmdClearColorImage(pass->commands, image.image, image.layout, &blue, 1, &image.range);
        return image.width == 320 && image.height == 180 && image.depth == 1;
    }
    if (strcmp(pass->custom, "mark") == 0 && pass->in_scope && program->knows_marks &&
        pass->queue_family == program->family) {
        FAILS(framewright_pass_image(pass, "mine", &image), MISUSE, "accesses no image `mine`");
        check(framewright_pass_image(pass, "screen", &image));
        if (image.layout != VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL || image.eye_form != FRAMEWRIGHT_EYE_FORM_NONE) {
            return 0;
        }
        VkClearAttachment white = {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = {.float32 = {1, 1, 1, 1}}}};
        VkClearRect corner = {{{0, 0}, {pass->width / 2, pass->height / 2}}, 0, 1};
        vkCmdClearAttachments(pass->commands, 1, &white, 1, &corner);
        return 1;
    }
    return 0;
}

static void count(void *findings, const char *text) {
    fprintf(stderr, "%s\n", text);
    ++*(size_t *)findings;
}

int main(void) {
    write_file("custom.ron", PIPELINE);
    FramewrightDeviceOptions options = {.struct_size = sizeof options, .validation = 1};
    FramewrightDevice *device;
    check(framewright_device_open(&options, &device));
    Program program = {NULL, 0, 0, VK_QUEUE_FAMILY_IGNORED};
    check(framewright_renderer_open(device, "custom.ron", NULL, &program.renderer));
    check(framewright_renderer_set_extent(program.renderer, 320, 180));
    FAILS(framewright_renderer_frame(program.renderer, NULL), MISTAKES, "no recorder was set");
    check(framewright_renderer_set_recorder(program.renderer, record, &program));
    FAILS(framewright_renderer_frame(program.renderer, NULL), MISTAKES, "doesn't record `mark`");
    program.knows_marks = 1;
    program.calls = 0;
    check(framewright_renderer_frame(program.renderer, NULL));

    FramewrightTexels texels;
    check(framewright_renderer_read(program.renderer, "screen", &texels));
    write_picture(&texels);
    size_t findings = 0;
    check(framewright_device_findings(device, count, &findings));
    framewright_renderer_free(program.renderer);
    framewright_device_free(device);
    return program.calls == 2 && findings == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
