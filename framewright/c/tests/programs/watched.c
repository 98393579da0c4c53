/* A program whose page is looked at: it draws until its folder has a file `end`. */

#include "testing.h"

static int ends(void) {
    FILE *file = fopen("end", "rb");
    if (file != NULL) {
        fclose(file);
    }
    return file != NULL;
}

int main(void) {
    FramewrightDevice *device;
    FramewrightScene *scene;
    FramewrightRenderer *renderer;
    FramewrightViewer *viewer;
    check(framewright_device_open(NULL, &device));
    check(framewright_scene_load("spheres_and_cubes", &scene));
    check(framewright_renderer_open(device, "forward", NULL, &renderer));
    check(framewright_renderer_set(renderer, "msaa", "4"));
    check(framewright_renderer_set_scene(renderer, scene));
    check(framewright_renderer_set_extent(renderer, 320, 180));

    const char *url;
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
    framewright_scene_free(scene);
    framewright_device_free(device);
    return EXIT_SUCCESS;
}
