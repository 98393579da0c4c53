/* An image of the program's that somebody else has between frames (DO-11). */

#include "testing.h"

int main(void) {
    OwnDevice own;
    open_vulkan(&own);
    open_device(&own, NULL);
    FramewrightScene *scene;
    check(framewright_scene_load("spheres_and_cubes", &scene));
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(own.device, "forward", NULL, &renderer));
    check(framewright_renderer_set_scene(renderer, scene));
    check(framewright_renderer_set_extent(renderer, 64, 36));

    VkImageCreateInfo image_info;
    check(framewright_renderer_image_info(renderer, "screen", &image_info));
    OwnImage image = own_image(&own, &image_info);
    check(framewright_renderer_import_images(renderer, "screen", &image.image, 1));

    /* Misuse. */
    FAILS(framewright_renderer_set_owner(renderer, "nobody", FRAMEWRIGHT_OWNER_EXTERNAL), MISUSE, "no external image or buffer `nobody`");
    HOLDS(framewright_renderer_set_owner(renderer, "screen", 3) == FRAMEWRIGHT_STATUS_MISUSE);
    HOLDS(framewright_renderer_set_owner(renderer, NULL, FRAMEWRIGHT_OWNER_DEVICE) != FRAMEWRIGHT_STATUS_OK);

    /* Each frame gives it away: then it can't be read. */
    FramewrightTexels texels;
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_read(renderer, "screen", &texels));
    check(framewright_renderer_set_owner(renderer, "screen", FRAMEWRIGHT_OWNER_EXTERNAL));
    for (int frame = 0; frame < 2; ++frame) {
        check(framewright_renderer_frame(renderer, NULL));
        HOLDS(framewright_renderer_read(renderer, "screen", &texels) != FRAMEWRIGHT_STATUS_OK);
        HOLDS(strstr(framewright_last_error(), "given back to its outside owner") != NULL);
    }
    FramewrightChange change;
    check(framewright_renderer_prepare(renderer, &change));
    check(framewright_renderer_prepare(renderer, &change));
    HOLDS(change == FRAMEWRIGHT_CHANGE_NOTHING);

    /* Another Plan has the same owner. */
    check(framewright_renderer_set(renderer, "msaa", "1"));
    check(framewright_renderer_prepare(renderer, &change));
    HOLDS(change == FRAMEWRIGHT_CHANGE_PLAN);
    check(framewright_renderer_import_images(renderer, "screen", &image.image, 1));
    check(framewright_renderer_frame(renderer, NULL));
    HOLDS(framewright_renderer_read(renderer, "screen", &texels) != FRAMEWRIGHT_STATUS_OK);

    /* From now on the device keeps it. */
    check(framewright_renderer_set_owner(renderer, "screen", FRAMEWRIGHT_OWNER_DEVICE));
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_read(renderer, "screen", &texels));

    framewright_renderer_free(renderer);
    framewright_scene_free(scene);
    free_image(&own, image);
    close_device(&own);
    close_vulkan(&own);
    return EXIT_SUCCESS;
}
