/* A device with exactly what a frame uses (DO-11, PF-8): it draws; with one feature less it is refused by name. Buffers of the program's
 * own in turn, the format of its images, and images that died. Prints what went wrong. */

#include <framewright.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST 64

static void check(FramewrightStatus status) {
    if (status != FRAMEWRIGHT_STATUS_OK) {
        fprintf(stderr, "%s\n", framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

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

/* A device with these features, and what the library says of it. */
typedef struct {
    FramewrightFeatures *features;
    VkDevice raw;
    FramewrightDevice *device;
} Made;

static Made made_of(VkInstance instance, VkPhysicalDevice physical, FramewrightFeatures *features) {
    Made made = {.features = features};
    FramewrightNames extensions = framewright_features_extensions(made.features);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1, &priority};
    VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = framewright_features_chain(made.features),
        .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue_info, .enabledExtensionCount = (uint32_t)extensions.count,
        .ppEnabledExtensionNames = extensions.names};
    expect(vkCreateDevice(physical, &info, NULL, &made.raw) == VK_SUCCESS, "no device");
    FramewrightQueue queue = {.family = 0};
    vkGetDeviceQueue(made.raw, 0, 0, &queue.queue);
    FramewrightAdoptedDevice program = {
        .struct_size = sizeof program, .instance = instance, .physical_device = physical, .device = made.raw,
        .device_extensions = extensions, .features = framewright_features_chain(made.features), .queues = &queue,
        .queue_count = 1};
    check(framewright_device_adopt(&program, &made.device));
    return made;
}

static Made made(VkInstance instance, VkPhysicalDevice physical, const FramewrightNames *used) {
    FramewrightFeatures *features;
    check(framewright_features_open(instance, physical, used, &features));
    return made_of(instance, physical, features);
}

static void destroy(Made made) {
    framewright_device_free(made.device);
    vkDestroyDevice(made.raw, NULL);
    framewright_features_free(made.features);
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
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "program", 0, NULL, 0, VK_API_VERSION_1_3};
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkInstance instance;
    expect(vkCreateInstance(&instance_info, NULL, &instance) == VK_SUCCESS, "no instance");
    uint32_t one = 1;
    VkPhysicalDevice physical;
    expect(vkEnumeratePhysicalDevices(instance, &one, &physical) >= 0, "no physical device");
    FramewrightScene *scene;
    check(framewright_scene_load("spheres_and_cubes", &scene));

    /* A device with all that the library uses tells what the frame uses. */
    Features used = {.count = 0};
    Made all = made(instance, physical, NULL);
    FramewrightRenderer *renderer = renderer_of(all.device, scene);
    check(framewright_renderer_features(renderer, feature, &used));
    expect(used.count > 4, "a frame uses more features");
    size_t dead = 0;
    check(framewright_device_dead_images(all.device, count, &dead));
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_set_output_format(renderer, VK_FORMAT_UNDEFINED));
    expect(framewright_renderer_set_output_format(renderer, (VkFormat)-1) == FRAMEWRIGHT_STATUS_MISUSE, "no such format");
    expect(framewright_renderer_import_buffers(renderer, "none", NULL, 0) != FRAMEWRIGHT_STATUS_OK, "no such buffer");
    check(framewright_device_dead_images(all.device, count, &dead));
    expect(dead == 0, "nothing died yet");
    framewright_renderer_free(renderer);
    check(framewright_device_dead_images(all.device, count, &dead));
    expect(dead > 0, "the images of a renderer die with it");
    destroy(all);

    /* Before there is a device of the program's, one for planning tells the same. */
    FramewrightDevice *planning;
    expect(framewright_device_open_physical(VK_NULL_HANDLE, NULL, physical, NULL, &planning) == FRAMEWRIGHT_STATUS_MISUSE,
           "no instance");
    check(framewright_device_open_physical(instance, NULL, physical, NULL, &planning));
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
    Made from_planning = made_of(instance, physical, features);
    renderer = renderer_of(from_planning.device, scene);
    check(framewright_renderer_frame(renderer, NULL));
    framewright_renderer_free(renderer);
    destroy(from_planning);

    /* One with exactly these draws. */
    FramewrightNames names = {used.names, used.count};
    Made exact = made(instance, physical, &names);
    renderer = renderer_of(exact.device, scene);
    check(framewright_renderer_frame(renderer, NULL));
    framewright_renderer_free(renderer);
    destroy(exact);

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
        Made less = made(instance, physical, &names);
        renderer = renderer_of(less.device, scene);
        expect(framewright_renderer_frame(renderer, NULL) != FRAMEWRIGHT_STATUS_OK, name);
        expect(strstr(framewright_last_error(), name) != NULL, framewright_last_error());
        printf("%s is missed\n", name);
        framewright_renderer_free(renderer);
        destroy(less);
    }
    framewright_scene_free(scene);
    vkDestroyInstance(instance, NULL);
    return EXIT_SUCCESS;
}
