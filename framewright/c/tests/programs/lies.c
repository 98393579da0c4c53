/* A custom pass that does what the pipeline doesn't say of it, and a renderer that holds it against that. */

#include "testing.h"

/* `look` reads `mine`, and so gets hold of it; `other` is to write `list` alone. */
static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"mine\", format: R8G8B8A8_UNORM, size: Output), (name: \"screen\", format: Output, size: Output)],\n"
    "    buffers: [(name: \"first\", bytes: 16), (name: \"list\", bytes: 16)],\n"
    "    passes: [(name: \"paint\", custom: \"paint\", writes: [\"mine\"],\n"
    "            uses: [(image: \"mine\", stages: [CLEAR], accesses: [TRANSFER_WRITE], layout: GENERAL)]),\n"
    "        (name: \"look\", custom: \"look\", reads: [\"mine\"], writes: [\"first\"],\n"
    "            uses: [(image: \"mine\", stages: [COPY], accesses: [TRANSFER_READ], layout: GENERAL)]),\n"
    "        (name: \"other\", custom: \"other\", reads: [\"first\"], writes: [\"list\"]),\n"
    "        (name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"mine\"}, color: [\"screen\"])],\n"
    "    outputs: [\"screen\", \"list\"])\n";

typedef struct {
    FramewrightPassImage mine;
    int lies;
} Program;

static uint32_t record(void *context, const FramewrightPass *pass) {
    Program *program = context;
    VkClearColorValue blue = {.float32 = {0, 0, 1, 1}}, red = {.float32 = {1, 0, 0, 1}};
    VkBuffer buffer;
    if (strcmp(pass->custom, "paint") == 0) {
        FramewrightPassImage mine;
        check(framewright_pass_image(pass, "mine", &mine));
        vkCmdClearColorImage(pass->commands, mine.image, mine.layout, &blue, 1, &mine.range);
    } else if (strcmp(pass->custom, "look") == 0) {
        check(framewright_pass_image(pass, "mine", &program->mine));
        check(framewright_pass_buffer(pass, "first", &buffer));
        vkCmdFillBuffer(pass->commands, buffer, 0, 16, 3);
    } else {
        check(framewright_pass_buffer(pass, "list", &buffer));
        vkCmdFillBuffer(pass->commands, buffer, 0, 16, 4);
        if (program->lies) {
            FramewrightPassImage *mine = &program->mine;
            vkCmdClearColorImage(pass->commands, mine->image, mine->layout, &red, 1, &mine->range);
        }
    }
    return 1;
}

/* Whether the picture is of this colour all over. */
static int shows(FramewrightRenderer *renderer, int red, int blue) {
    FramewrightTexels texels;
    check(framewright_renderer_read(renderer, "screen", &texels));
    for (size_t at = 0; at + 4 <= texels.byte_count; at += 4) {
        if (texels.bytes[at] != red || texels.bytes[at + 2] != blue) {
            return 0;
        }
    }
    return 1;
}

int main(void) {
    write_file("lies.ron", PIPELINE);
    FramewrightDevice *device;
    check(framewright_device_open(NULL, &device));
    int right = 1;
    for (uint32_t checked = 0; checked < 2; ++checked) {
        Program program = {.lies = 0};
        FramewrightRendererOptions options = {.struct_size = sizeof options, .check_uses = checked};
        FramewrightRenderer *renderer;
        check(framewright_renderer_open(device, "lies.ron", &options, &renderer));
        check(framewright_renderer_set_extent(renderer, 32, 16));
        check(framewright_renderer_set_recorder(renderer, record, &program));
        for (int frame = 0; frame < 5; ++frame) {
            check(framewright_renderer_frame(renderer, NULL));
        }
        right &= shows(renderer, 0, 255);
        program.lies = 1;
        FramewrightStatus status = framewright_renderer_frame(renderer, NULL);
        const char *wanted = "pass `other` (lies.ron:8:16) doesn't name `mine`, and ";
        if (checked && status != FRAMEWRIGHT_STATUS_MISUSE) {
            fprintf(stderr, "status %d\n", status);
            right = 0;
        }
        if (checked && strstr(framewright_last_error(), wanted) == NULL) {
            fprintf(stderr, "%s\n", framewright_last_error());
            right = 0;
        }
        /* Garbage was in the image meanwhile, and it was given back what it held. */
        right &= checked ? shows(renderer, 0, 255) : shows(renderer, 255, 0);
        program.lies = 0;
        check(framewright_renderer_frame(renderer, NULL));
        framewright_renderer_free(renderer);
    }
    framewright_device_free(device);
    return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
