/* A device with exactly what a frame uses (DO-11, PF-8): it draws; with one feature less it is refused by name. Buffers of the program's
 * own in turn, the format of its images, and images that died. Prints what went wrong. */

#include "testing.h"

#define MOST 64

static void expect(int right, const char *what) {
    if (!right) {
        fprintf(stderr, "%s\n", what);
        exit(EXIT_FAILURE);
    }
}

typedef struct {
    const char *names[MOST];
    size_t count;
} Features;

static void feature(void *context, const char *name, const char *used_by) {
    Features *features = context;
    expect(features->count < MOST && used_by[0] != 0, "a feature without its cause");
    char *kept = malloc(strlen(name) + 1);
    strcpy(kept, name);
    features->names[features->count++] = kept;
}

static void count(void *dead, VkImage image) {
    expect(image != VK_NULL_HANDLE, "no image died");
    ++*(size_t *)dead;
}

static FramewrightRenderer *renderer_of(FramewrightDevice *device, FramewrightScene *scene) {
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(device, "forward", NULL, &renderer));
    check(framewright_renderer_set(renderer, "msaa", "4"));
    check(framewright_renderer_set_scene(renderer, scene));
    check(framewright_renderer_set_extent(renderer, 320, 180));
    return renderer;
}

int main(void) {
    OwnDevice own;
    open_vulkan(&own);
    FramewrightScene *scene;
    check(framewright_scene_load("spheres_and_cubes", &scene));

    /* A device with all that the library uses tells what the frame uses. */
    Features used = {.count = 0};
    open_device(&own, NULL);
    FramewrightRenderer *renderer = renderer_of(own.device, scene);
    check(framewright_renderer_features(renderer, feature, &used));
    expect(used.count > 4, "a frame uses more features");
    size_t dead = 0;
    check(framewright_device_dead_images(own.device, count, &dead));
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_set_output_format(renderer, VK_FORMAT_UNDEFINED));
    expect(framewright_renderer_set_output_format(renderer, (VkFormat)-1) == FRAMEWRIGHT_STATUS_MISUSE, "no such format");
    expect(framewright_renderer_import_buffers(renderer, "none", NULL, 0) != FRAMEWRIGHT_STATUS_OK, "no such buffer");
    check(framewright_device_dead_images(own.device, count, &dead));
    expect(dead == 0, "nothing died yet");
    framewright_renderer_free(renderer);
    check(framewright_device_dead_images(own.device, count, &dead));
    expect(dead > 0, "the images of a renderer die with it");
    close_device(&own);

    /* Before there is a device of the program's, one for planning tells the same. */
    FramewrightDevice *planning;
    expect(framewright_device_open_physical(VK_NULL_HANDLE, NULL, own.physical, NULL, &planning) == FRAMEWRIGHT_STATUS_MISUSE,
           "no instance");
    check(framewright_device_open_physical(own.instance, NULL, own.physical, NULL, &planning));
    renderer = renderer_of(planning, scene);
    Features planned = {.count = 0};
    check(framewright_renderer_features(renderer, feature, &planned));
    expect(planned.count == used.count, "planning tells as many features");
    for (size_t at = 0; at < used.count; ++at) {
        expect(strcmp(planned.names[at], used.names[at]) == 0, planned.names[at]);
    }
    FramewrightFeatures *features;
    check(framewright_renderer_device_features(renderer, &features));
    framewright_renderer_free(renderer);
    framewright_device_free(planning);
    open_device_with(&own, features);
    renderer = renderer_of(own.device, scene);
    check(framewright_renderer_frame(renderer, NULL));
    framewright_renderer_free(renderer);
    close_device(&own);

    /* One with exactly these draws. */
    FramewrightNames names = {used.names, used.count};
    open_device(&own, &names);
    renderer = renderer_of(own.device, scene);
    check(framewright_renderer_frame(renderer, NULL));
    framewright_renderer_free(renderer);
    close_device(&own);

    /* With one less it is refused by name. Queues, memory and frames of each plan need those that aren't left out. */
    for (size_t left_out = 0; left_out < used.count; ++left_out) {
        Features fewer = {.count = 0};
        for (size_t at = 0; at < used.count; ++at) {
            if (at != left_out) {
                fewer.names[fewer.count++] = used.names[at];
            }
        }
        const char *name = used.names[left_out];
        const char *everywhere[] = {"synchronization2", "maintenance4", "timelineSemaphore", "hostQueryReset"};
        int always = 0;
        for (size_t at = 0; at < 4; ++at) {
            always |= strcmp(name, everywhere[at]) == 0;
        }
        if (always) {
            continue;
        }
        names = (FramewrightNames){fewer.names, fewer.count};
        open_device(&own, &names);
        renderer = renderer_of(own.device, scene);
        expect(framewright_renderer_frame(renderer, NULL) != FRAMEWRIGHT_STATUS_OK, name);
        expect(strstr(framewright_last_error(), name) != NULL, framewright_last_error());
        printf("%s is missed\n", name);
        framewright_renderer_free(renderer);
        close_device(&own);
    }
    framewright_scene_free(scene);
    close_vulkan(&own);
    return EXIT_SUCCESS;
}
