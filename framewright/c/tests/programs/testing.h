/* What the programs share: how they fail, files, and a device of their own with buffers and images. */

#ifndef TESTING_H
#define TESTING_H

#include <framewright.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Ends the program if a call failed. */
static inline void check(FramewrightStatus status) {
    if (status != FRAMEWRIGHT_STATUS_OK) {
        fprintf(stderr, "%s\n", framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

static inline void vk(VkResult result) {
    if (result < 0) {
        fprintf(stderr, "Vulkan's result is %d\n", result);
        exit(EXIT_FAILURE);
    }
}

static inline void holds(int line, int condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "line %d: `%s` doesn't hold: %s\n", line, what, framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

/* Ends the program if a condition doesn't hold. */
#define HOLDS(condition) holds(__LINE__, condition, #condition)

static inline void fails(int line, FramewrightStatus status, FramewrightStatus wanted, const char *words) {
    if (status != wanted || strstr(framewright_last_error(), words) == NULL) {
        fprintf(
            stderr, "line %d: status %d, and not %d with `%s`: %s\n", line, status, wanted, words, framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

/* Ends the program unless a call fails with this status and these words. */
#define FAILS(status, wanted, words) fails(__LINE__, status, FRAMEWRIGHT_STATUS_##wanted, words)

static inline void write_file(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    if (file == NULL || fputs(text, file) < 0 || fclose(file) != 0) {
        exit(EXIT_FAILURE);
    }
}

/* Writes four bytes a texel as picture.ppm, of three. */
static inline void write_picture(const FramewrightTexels *texels) {
    FILE *file = fopen("picture.ppm", "wb");
    if (file == NULL) {
        exit(EXIT_FAILURE);
    }
    fprintf(file, "P6\n%u %u\n255\n", texels->width, texels->height);
    for (size_t at = 0; at + 4 <= texels->byte_count; at += 4) {
        fwrite(texels->bytes + at, 1, 3, file);
    }
    fclose(file);
}

/* A device that the program makes itself, and hands in. */
typedef struct {
    VkInstance instance;
    VkPhysicalDevice physical;
    FramewrightFeatures *features;
    VkDevice raw;
    FramewrightQueue queue;
    FramewrightDevice *device;
} OwnDevice;

/* Makes the instance, and chooses the first physical device. */
static inline void open_vulkan(OwnDevice *own) {
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "program", 0, NULL, 0, VK_API_VERSION_1_3};
    VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    uint32_t one = 1;
    vk(vkCreateInstance(&info, NULL, &own->instance));
    vk(vkEnumeratePhysicalDevices(own->instance, &one, &own->physical));
}

/* Makes the device with these features, which it keeps. */
static inline void open_device_with(OwnDevice *own, FramewrightFeatures *features) {
    own->features = features;
    FramewrightNames extensions = framewright_features_extensions(own->features);
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1, &priority};
    VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = framewright_features_chain(own->features),
        .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue_info, .enabledExtensionCount = (uint32_t)extensions.count,
        .ppEnabledExtensionNames = extensions.names};
    vk(vkCreateDevice(own->physical, &info, NULL, &own->raw));
    own->queue.family = 0;
    vkGetDeviceQueue(own->raw, 0, 0, &own->queue.queue);
    FramewrightAdoptedDevice program = {
        .struct_size = sizeof program, .instance = own->instance, .physical_device = own->physical, .device = own->raw,
        .device_extensions = extensions, .features = framewright_features_chain(own->features), .queues = &own->queue,
        .queue_count = 1};
    check(framewright_device_adopt(&program, &own->device));
}

/* Makes the device with the features of these names; NULL: with all that the library may use. */
static inline void open_device(OwnDevice *own, const FramewrightNames *used) {
    FramewrightFeatures *features;
    check(framewright_features_open(own->instance, own->physical, used, &features));
    open_device_with(own, features);
}

/* Destroys the device. What was made from it is gone by then. */
static inline void close_device(OwnDevice *own) {
    framewright_device_free(own->device);
    vkDestroyDevice(own->raw, NULL);
    framewright_features_free(own->features);
}

static inline void close_vulkan(OwnDevice *own) {
    vkDestroyInstance(own->instance, NULL);
}

/* Memory of a kind that fits, with what is chained to its allocation. */
static inline VkDeviceMemory own_memory(
    const OwnDevice *own, VkMemoryRequirements needs, VkMemoryPropertyFlags properties, const void *chain) {
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(own->physical, &types);
    VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, chain, needs.size, 0};
    while (!(needs.memoryTypeBits >> info.memoryTypeIndex & 1)
           || (types.memoryTypes[info.memoryTypeIndex].propertyFlags & properties) != properties) {
        HOLDS(++info.memoryTypeIndex < types.memoryTypeCount);
    }
    VkDeviceMemory memory;
    vk(vkAllocateMemory(own->raw, &info, NULL, &memory));
    return memory;
}

/* A buffer that the program writes by `bytes`. */
typedef struct {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *bytes;
} OwnBuffer;

static inline OwnBuffer own_buffer(const OwnDevice *own, VkBufferUsageFlags usage, VkDeviceSize size) {
    VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    VkMemoryAllocateFlagsInfo flags = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    OwnBuffer made;
    VkMemoryRequirements needs;
    vk(vkCreateBuffer(own->raw, &info, NULL, &made.buffer));
    vkGetBufferMemoryRequirements(own->raw, made.buffer, &needs);
    const VkMemoryPropertyFlags mapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    made.memory = own_memory(own, needs, mapped, usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT ? &flags : NULL);
    vk(vkBindBufferMemory(own->raw, made.buffer, made.memory, 0));
    vk(vkMapMemory(own->raw, made.memory, 0, VK_WHOLE_SIZE, 0, &made.bytes));
    return made;
}

/* A buffer with these contents. */
static inline OwnBuffer filled_buffer(const OwnDevice *own, VkBufferUsageFlags usage, const void *bytes, size_t size) {
    OwnBuffer made = own_buffer(own, usage, size);
    memcpy(made.bytes, bytes, size);
    return made;
}

static inline void free_buffer(const OwnDevice *own, OwnBuffer made) {
    vkDestroyBuffer(own->raw, made.buffer, NULL);
    vkFreeMemory(own->raw, made.memory, NULL);
}

/* An image with memory of its own. */
typedef struct {
    VkImage image;
    VkDeviceMemory memory;
} OwnImage;

static inline OwnImage own_image(const OwnDevice *own, const VkImageCreateInfo *info) {
    OwnImage made;
    VkMemoryRequirements needs;
    vk(vkCreateImage(own->raw, info, NULL, &made.image));
    vkGetImageMemoryRequirements(own->raw, made.image, &needs);
    made.memory = own_memory(own, needs, 0, NULL);
    vk(vkBindImageMemory(own->raw, made.image, made.memory, 0));
    return made;
}

static inline void free_image(const OwnDevice *own, OwnImage made) {
    vkDestroyImage(own->raw, made.image, NULL);
    vkFreeMemory(own->raw, made.memory, NULL);
}

/* An image of one texel that shaders read, in this colour. */
static inline OwnImage own_texel(const OwnDevice *own, VkClearColorValue color) {
    VkImageCreateInfo image_info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, .imageType = VK_IMAGE_TYPE_2D, .format = VK_FORMAT_R8G8B8A8_UNORM,
        .extent = {1, 1, 1}, .mipLevels = 1, .arrayLayers = 1, .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    OwnImage made = own_image(own, &image_info);
    VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, own->queue.family};
    VkCommandPool pool;
    vk(vkCreateCommandPool(own->raw, &pool_info, NULL, &pool));
    VkCommandBufferAllocateInfo allocate = {
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands;
    vk(vkAllocateCommandBuffers(own->raw, &allocate, &commands));
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, .pNext = NULL};
    vk(vkBeginCommandBuffer(commands, &begin));
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER, .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .newLayout = VK_IMAGE_LAYOUT_GENERAL, .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED, .image = made.image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
    vkCmdClearColorImage(commands, made.image, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &barrier.subresourceRange);
    barrier.srcAccessMask = barrier.dstAccessMask;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_GENERAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
    vk(vkEndCommandBuffer(commands));
    VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    vk(vkQueueSubmit(own->queue.queue, 1, &submit, VK_NULL_HANDLE));
    vk(vkQueueWaitIdle(own->queue.queue));
    vkDestroyCommandPool(own->raw, pool, NULL);
    return made;
}

/* A view of such an image, with a sampler of its own. */
static inline VkDescriptorImageInfo own_view(const OwnDevice *own, OwnImage image) {
    VkSamplerCreateInfo sampler_info = {.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    VkImageViewCreateInfo view_info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, .image = image.image, .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = VK_FORMAT_R8G8B8A8_UNORM, .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VkDescriptorImageInfo made = {.imageLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    vk(vkCreateSampler(own->raw, &sampler_info, NULL, &made.sampler));
    vk(vkCreateImageView(own->raw, &view_info, NULL, &made.imageView));
    return made;
}

static inline void free_view(const OwnDevice *own, VkDescriptorImageInfo made) {
    vkDestroyImageView(own->raw, made.imageView, NULL);
    vkDestroySampler(own->raw, made.sampler, NULL);
}

#endif
