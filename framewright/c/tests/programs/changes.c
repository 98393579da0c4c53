/* What changes between frames, by whichever call it is planned. */

#include "testing.h"

static FramewrightRenderer *open_renderer(const FramewrightDevice *device, const FramewrightScene *scene, uint32_t width) {
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(device, "forward", NULL, &renderer));
    check(framewright_renderer_set_scene(renderer, scene));
    check(framewright_renderer_set_extent(renderer, width, 48));
    check(framewright_renderer_frame(renderer, NULL));
    return renderer;
}

static FramewrightChange changed(FramewrightRenderer *renderer) {
    FramewrightChange change;
    check(framewright_renderer_prepare(renderer, &change));
    return change;
}

int main(void) {
    FramewrightDevice *device;
    check(framewright_device_open(NULL, &device));
    FramewrightScene *scene;
    check(framewright_scene_load("spheres_and_cubes", &scene));
    FramewrightRenderer *renderer = open_renderer(device, scene, 32), *fresh = open_renderer(device, scene, 128);
    HOLDS(changed(renderer) == FRAMEWRIGHT_CHANGE_PLAN && changed(renderer) == FRAMEWRIGHT_CHANGE_NOTHING);

    /* A call that asks for an image plans: the scene follows, and the program is told. */
    check(framewright_renderer_set_extent(renderer, 128, 48));
    VkImageCreateInfo info;
    check(framewright_renderer_image_info(renderer, "screen", &info));
    HOLDS(info.extent.width == 128);
    HOLDS(changed(renderer) == FRAMEWRIGHT_CHANGE_PLAN && changed(renderer) == FRAMEWRIGHT_CHANGE_NOTHING);
    check(framewright_renderer_frame(renderer, NULL));
    FramewrightTexels texels, wanted;
    check(framewright_renderer_read(renderer, "screen", &texels));
    check(framewright_renderer_read(fresh, "screen", &wanted));
    HOLDS(texels.byte_count == wanted.byte_count && memcmp(texels.bytes, wanted.bytes, wanted.byte_count) == 0);

    /* The image of the last frame is told without a plan. */
    check(framewright_renderer_set(renderer, "msaa", "1"));
    VkImage image, again;
    check(framewright_renderer_image(renderer, "screen", &image));
    check(framewright_renderer_set(renderer, "msaa", NULL));

    /* An image that was imported is gone with its Plan. */
    check(framewright_renderer_image(fresh, "screen", &image));
    check(framewright_renderer_import_images(renderer, "screen", &image, 1));
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_image(renderer, "screen", &again));
    HOLDS(again == image);
    check(framewright_renderer_set(renderer, "msaa", "1"));
    HOLDS(framewright_renderer_frame(renderer, NULL) == FRAMEWRIGHT_STATUS_MISUSE);
    HOLDS(strstr(framewright_last_error(), "`screen` is to be imported again") != NULL);
    HOLDS(changed(renderer) == FRAMEWRIGHT_CHANGE_PLAN);
    check(framewright_renderer_import_images(renderer, "screen", &image, 1));
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_reload(renderer));
    HOLDS(framewright_renderer_frame(renderer, NULL) == FRAMEWRIGHT_STATUS_MISUSE);
    HOLDS(changed(renderer) == FRAMEWRIGHT_CHANGE_PLAN);

    framewright_renderer_free(renderer);
    framewright_renderer_free(fresh);
    framewright_scene_free(scene);
    framewright_device_free(device);
    return EXIT_SUCCESS;
}
