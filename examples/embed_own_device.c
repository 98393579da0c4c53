/* Framewright on a device of a program in C: it draws into an image of the program's, within its command buffer.
 *
 *     cargo build --package framewright-c
 *     cc examples/embed_own_device.c -Iframewright/c -Ltarget/debug -lframewright_c -lvulkan -o embed_own_device
 *     LD_LIBRARY_PATH=target/debug ./embed_own_device picture.ppm */

#include <framewright.h>
#include <stdio.h>
#include <stdlib.h>

static void check(FramewrightStatus status) {
    if (status != FRAMEWRIGHT_STATUS_OK) {
        fprintf(stderr, "%s\n", framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

static void vk(VkResult result) {
    if (result < 0) {
        fprintf(stderr, "Vulkan's result is %d\n", result);
        exit(EXIT_FAILURE);
    }
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
    /* The program's own Vulkan. It switches on all features that the device has; `framewright_device_adopt` names what is missing. */
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "program", 0, NULL, 0, VK_API_VERSION_1_3};
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    VkInstance instance;
    vk(vkCreateInstance(&instance_info, NULL, &instance));
    uint32_t one = 1;
    VkPhysicalDevice physical;
    vk(vkEnumeratePhysicalDevices(instance, &one, &physical));
    VkPhysicalDeviceVulkan13Features v1_3 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v1_2 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v1_3};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v1_2};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1, &priority};
    VkDeviceCreateInfo device_info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = &features, .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue_info};
    VkDevice raw;
    vk(vkCreateDevice(physical, &device_info, NULL, &raw));
    FramewrightQueue queue = {.family = 0};
    vkGetDeviceQueue(raw, 0, 0, &queue.queue);

    FramewrightAdoptedDevice program = {
        .struct_size = sizeof program, .instance = instance, .physical_device = physical, .device = raw,
        .features = &features, .queues = &queue, .queue_count = 1};
    FramewrightDevice *device;
    check(framewright_device_adopt(&program, &device));
    FramewrightScene *scene;
    check(framewright_scene_load("spheres_and_cubes", &scene));
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(device, "forward", NULL, &renderer));
    check(framewright_renderer_set_scene(renderer, scene));
    check(framewright_renderer_set_extent(renderer, 320, 180));

    /* An image of the program's takes the place of the pipeline's `screen`. */
    VkImageCreateInfo image_info;
    check(framewright_renderer_image_info(renderer, "screen", &image_info));
    VkImage image;
    vk(vkCreateImage(raw, &image_info, NULL, &image));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(raw, image, &needs);
    VkMemoryAllocateInfo memory_info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size, 0};
    while (!(needs.memoryTypeBits >> memory_info.memoryTypeIndex & 1)) {
        ++memory_info.memoryTypeIndex;
    }
    VkDeviceMemory memory;
    vk(vkAllocateMemory(raw, &memory_info, NULL, &memory));
    vk(vkBindImageMemory(raw, image, memory, 0));
    check(framewright_renderer_import_images(renderer, "screen", &image, 1));

    /* The frame goes into a command buffer of the program's, among its own commands. */
    VkSemaphoreTypeCreateInfo timeline = {
        VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, NULL, VK_SEMAPHORE_TYPE_TIMELINE, 0};
    VkSemaphoreCreateInfo semaphore_info = {VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &timeline, 0};
    FramewrightSemaphore done = {.value = 1};
    vk(vkCreateSemaphore(raw, &semaphore_info, NULL, &done.semaphore));
    VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, queue.family};
    VkCommandPool pool;
    vk(vkCreateCommandPool(raw, &pool_info, NULL, &pool));
    VkCommandBufferAllocateInfo allocate = {
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands;
    vk(vkAllocateCommandBuffers(raw, &allocate, &commands));
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, .pNext = NULL};
    vk(vkBeginCommandBuffer(commands, &begin));
    uint64_t frame;
    check(framewright_renderer_record_into(renderer, commands, &done, NULL, 0, &frame));
    /* What follows finds the image in this state; here, nothing does. */
    FramewrightState after;
    check(framewright_renderer_states(renderer, "screen", NULL, &after));
    vk(vkEndCommandBuffer(commands));
    VkCommandBufferSubmitInfo submitted = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, NULL, commands, 0};
    VkSemaphoreSubmitInfo signal = {
        VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, NULL, done.semaphore, done.value, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0};
    VkSubmitInfo2 submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO_2, NULL, 0, 0, NULL, 1, &submitted, 1, &signal};
    vk(vkQueueSubmit2(queue.queue, 1, &submit, VK_NULL_HANDLE));
    check(framewright_renderer_wait(renderer, frame));

    FramewrightTexels texels;
    check(framewright_renderer_read(renderer, "screen", &texels));
    int written = write_picture(argv[1], &texels);
    printf("drawn by %s, and left in the layout %d\n", framewright_device_name(device), after.layout);

    /* What was made from the device goes before it. */
    framewright_renderer_free(renderer);
    framewright_scene_free(scene);
    framewright_device_free(device);
    vkDestroyCommandPool(raw, pool, NULL);
    vkDestroySemaphore(raw, done.semaphore, NULL);
    vkDestroyImage(raw, image, NULL);
    vkFreeMemory(raw, memory, NULL);
    vkDestroyDevice(raw, NULL);
    vkDestroyInstance(instance, NULL);
    return written ? EXIT_SUCCESS : EXIT_FAILURE;
}
