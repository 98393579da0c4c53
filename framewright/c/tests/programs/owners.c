/* An image of the program's that somebody else has between frames (DO-11). */

#include <framewright.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void holds(int line, int condition) {
    if (!condition) {
        fprintf(stderr, "line %d doesn't hold: %s\n", line, framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

#define HOLDS(condition) holds(__LINE__, condition)
#define CHECK(status) HOLDS((status) == FRAMEWRIGHT_STATUS_OK)
#define VK(result) HOLDS((result) == VK_SUCCESS)

int main(void) {
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "program", 0, NULL, 0, VK_API_VERSION_1_3};
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkInstance instance;
    VK(vkCreateInstance(&instance_info, NULL, &instance));
    uint32_t one = 1;
    VkPhysicalDevice physical;
    HOLDS(vkEnumeratePhysicalDevices(instance, &one, &physical) >= 0);
    FramewrightFeatures *features;
    CHECK(framewright_features_open(instance, physical, NULL, &features));
    FramewrightNames extensions = framewright_features_extensions(features);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1, &priority};
    VkDeviceCreateInfo device_info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = framewright_features_chain(features),
        .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue_info, .enabledExtensionCount = (uint32_t)extensions.count,
        .ppEnabledExtensionNames = extensions.names};
    VkDevice raw;
    VK(vkCreateDevice(physical, &device_info, NULL, &raw));
    FramewrightQueue queue = {.family = 0};
    vkGetDeviceQueue(raw, 0, 0, &queue.queue);
    FramewrightAdoptedDevice program = {
        .struct_size = sizeof program, .instance = instance, .physical_device = physical, .device = raw,
        .device_extensions = extensions, .features = framewright_features_chain(features), .queues = &queue,
        .queue_count = 1};
    FramewrightDevice *device;
    CHECK(framewright_device_adopt(&program, &device));
    FramewrightScene *scene;
    CHECK(framewright_scene_load("spheres_and_cubes", &scene));
    FramewrightRenderer *renderer;
    CHECK(framewright_renderer_open(device, "forward", NULL, &renderer));
    CHECK(framewright_renderer_set_scene(renderer, scene));
    CHECK(framewright_renderer_set_extent(renderer, 64, 36));

    VkImageCreateInfo image_info;
    CHECK(framewright_renderer_image_info(renderer, "screen", &image_info));
    VkImage image;
    VK(vkCreateImage(raw, &image_info, NULL, &image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(raw, image, &needs);
    VkMemoryAllocateInfo memory_info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size, 0};
    while (!(needs.memoryTypeBits >> memory_info.memoryTypeIndex & 1)) {
        ++memory_info.memoryTypeIndex;
    }
    VkDeviceMemory memory;
    VK(vkAllocateMemory(raw, &memory_info, NULL, &memory));
    VK(vkBindImageMemory(raw, image, memory, 0));
    CHECK(framewright_renderer_import_images(renderer, "screen", &image, 1));

    /* Misuse. */
    HOLDS(framewright_renderer_set_owner(renderer, "nobody", FRAMEWRIGHT_OWNER_EXTERNAL) == FRAMEWRIGHT_STATUS_MISUSE);
    HOLDS(strstr(framewright_last_error(), "no external image or buffer `nobody`") != NULL);
    HOLDS(framewright_renderer_set_owner(renderer, "screen", 3) == FRAMEWRIGHT_STATUS_MISUSE);
    HOLDS(framewright_renderer_set_owner(renderer, NULL, FRAMEWRIGHT_OWNER_DEVICE) != FRAMEWRIGHT_STATUS_OK);

    /* Each frame gives it away: then it can't be read. */
    FramewrightTexels texels;
    CHECK(framewright_renderer_frame(renderer, NULL));
    CHECK(framewright_renderer_read(renderer, "screen", &texels));
    CHECK(framewright_renderer_set_owner(renderer, "screen", FRAMEWRIGHT_OWNER_EXTERNAL));
    for (int frame = 0; frame < 2; ++frame) {
        CHECK(framewright_renderer_frame(renderer, NULL));
        HOLDS(framewright_renderer_read(renderer, "screen", &texels) != FRAMEWRIGHT_STATUS_OK);
        HOLDS(strstr(framewright_last_error(), "given back to its outside owner") != NULL);
    }
    FramewrightChange change;
    CHECK(framewright_renderer_prepare(renderer, &change));
    CHECK(framewright_renderer_prepare(renderer, &change));
    HOLDS(change == FRAMEWRIGHT_CHANGE_NOTHING);

    /* Another Plan has the same owner. */
    CHECK(framewright_renderer_set(renderer, "msaa", "1"));
    CHECK(framewright_renderer_prepare(renderer, &change));
    HOLDS(change == FRAMEWRIGHT_CHANGE_PLAN);
    CHECK(framewright_renderer_import_images(renderer, "screen", &image, 1));
    CHECK(framewright_renderer_frame(renderer, NULL));
    HOLDS(framewright_renderer_read(renderer, "screen", &texels) != FRAMEWRIGHT_STATUS_OK);

    /* From now on the device keeps it. */
    CHECK(framewright_renderer_set_owner(renderer, "screen", FRAMEWRIGHT_OWNER_DEVICE));
    CHECK(framewright_renderer_frame(renderer, NULL));
    CHECK(framewright_renderer_read(renderer, "screen", &texels));

    framewright_renderer_free(renderer);
    framewright_scene_free(scene);
    framewright_device_free(device);
    framewright_features_free(features);
    vkDestroyImage(raw, image, NULL);
    vkFreeMemory(raw, memory, NULL);
    vkDestroyDevice(raw, NULL);
    vkDestroyInstance(instance, NULL);
    return EXIT_SUCCESS;
}
