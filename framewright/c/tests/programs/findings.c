/* A program whose pass breaks a rule of Vulkan: its page says where. It draws until its folder has a file `end`. */

#include "testing.h"

static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"mine\", format: Color(hdr: false), size: Output), (name: \"screen\", format: Output, size: Output)],\n"
    "    passes: [(name: \"whole\", custom: \"fill\", writes: [\"mine\"],\n"
    "        uses: [(image: \"mine\", stages: [CLEAR], accesses: [TRANSFER_WRITE], layout: GENERAL)]),\n"
    "        (name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"mine\"}, color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";

static uint32_t record(void *context, const FramewrightPass *pass) {
    (void)context;
    FramewrightPassImage image;
    check(framewright_pass_image(pass, "mine", &image));
    VkClearColorValue blue = {.float32 = {0, 0, 1, 1}};
    vkCmdClearColorImage(pass->commands, image.image, image.layout, &blue, 1, &image.range);
    /* Depths lie within 0 to 1. No draw follows that would see it. */
    vkCmdSetDepthBounds(pass->commands, 2.0f, 3.0f);
    return 1;
}

static int ends(void) {
    FILE *file = fopen("end", "rb");
    if (file != NULL) {
        fclose(file);
    }
    return file != NULL;
}

int main(void) {
    write_file("broken.ron", PIPELINE);
    FramewrightDeviceOptions options = {.struct_size = sizeof options, .validation = 1};
    FramewrightDevice *device;
    FramewrightRenderer *renderer;
    FramewrightViewer *viewer;
    const char *url;
    check(framewright_device_open(&options, &device));
    check(framewright_renderer_open(device, "broken.ron", NULL, &renderer));
    check(framewright_renderer_set_extent(renderer, 32, 16));
    check(framewright_renderer_set_recorder(renderer, record, NULL));
    check(framewright_viewer_serve("127.0.0.1:0", &viewer));
    check(framewright_viewer_url(viewer, &url));
    printf("%s\n", url);
    fflush(stdout);
    while (!ends()) {
        check(framewright_renderer_frame(renderer, NULL));
        check(framewright_viewer_frame(viewer, renderer));
    }
    framewright_viewer_free(viewer);
    framewright_renderer_free(renderer);
    framewright_device_free(device);
    return EXIT_SUCCESS;
}
