/* Framewright within a program in C: from a pipeline file to a picture.
 *
 *     cargo build --package framewright-c
 *     cc examples/embed_minimal.c -Iframewright/c -Ltarget/debug -lframewright_c -o embed_minimal
 *     LD_LIBRARY_PATH=target/debug ./embed_minimal picture.ppm
 *
 * With a second argument the validation layer watches. */

#include <framewright.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program if a call failed. Texts of mistakes in files have line and column. */
static void check(FramewrightStatus status) {
    if (status != FRAMEWRIGHT_STATUS_OK) {
        fprintf(stderr, "%s\n", framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

static void count(void *findings, const char *text) {
    fprintf(stderr, "%s\n", text);
    ++*(size_t *)findings;
}

/* Writes four bytes a texel as a picture of three. */
static int write_picture(const char *path, const FramewrightTexels *texels) {
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return 0;
    }
    fprintf(file, "P6\n%u %u\n255\n", texels->width, texels->height);
    for (size_t at = 0; at + 4 <= texels->byte_count; at += 4) {
        fwrite(texels->bytes + at, 1, 3, file);
    }
    return fclose(file) == 0;
}

int main(int argc, char **argv) {
    if (argc < 2 || framewright_abi() != FRAMEWRIGHT_ABI) {
        fprintf(stderr, "usage: %s PICTURE, with framewright %s\n", argv[0], framewright_version());
        return 2;
    }
    FramewrightDeviceOptions options = {.struct_size = sizeof options, .validation = argc > 2};
    FramewrightDevice *device;
    check(framewright_device_open(&options, &device));
    FramewrightScene *scene;
    check(framewright_scene_load("spheres_and_cubes", &scene));
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(device, "forward", NULL, &renderer));

    check(framewright_renderer_set(renderer, "msaa", "4"));
    check(framewright_renderer_set_scene(renderer, scene));
    check(framewright_renderer_set_extent(renderer, 320, 180));
    check(framewright_renderer_frame(renderer, NULL));
    FramewrightTexels texels;
    check(framewright_renderer_read(renderer, "screen", &texels));
    int written = texels.format == VK_FORMAT_R8G8B8A8_SRGB && write_picture(argv[1], &texels);

    size_t findings = 0;
    check(framewright_device_findings(device, count, &findings));
    printf("drawn by %s\n", framewright_device_name(device));
    framewright_renderer_free(renderer);
    framewright_scene_free(scene);
    framewright_device_free(device);
    return written && findings == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
