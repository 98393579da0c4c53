/* A descriptor set that a program in C makes and binds itself: a colour in a uniform buffer, at two dynamic offsets. Writes nothing. */

#include <framewright.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"screen\", format: Output, size: Output)],\n"
    "    passes: [(name: \"tint\", draw: FullScreen(\"tint\"), color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";

static const char SHADER[] =
    "#version 460\n"
    "layout(set = 3, binding = 1) uniform Tint { vec4 tint; };\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() { color = tint; }\n";

/* Follows the address of a colour. */
static const char FOLLOWS[] =
    "#version 460\n"
    "#extension GL_EXT_buffer_reference : require\n"
    "layout(buffer_reference, std430) readonly buffer Color { vec4 color; };\n"
    "layout(set = 3, binding = 1) uniform Head { Color head; };\n"
    "layout(location = 0) out vec4 color;\n"
    "void main() { color = head.color; }\n";

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

/* Fails with the status and these words. */
static void fails(int line, FramewrightStatus status, FramewrightStatus wanted, const char *words) {
    if (status != wanted || strstr(framewright_last_error(), words) == NULL) {
        fprintf(
            stderr, "line %d: status %d, and not %d with `%s`: %s\n", line, status, wanted, words, framewright_last_error());
        exit(EXIT_FAILURE);
    }
}

#define FAILS(status, wanted, words) fails(__LINE__, status, FRAMEWRIGHT_STATUS_##wanted, words)

static void write_file(const char *path, const char *text) {
    FILE *file = fopen(path, "wb");
    if (file == NULL || fputs(text, file) < 0 || fclose(file) != 0) {
        exit(EXIT_FAILURE);
    }
}

/* The first texel of a frame, in three bytes. */
static uint32_t drawn(FramewrightRenderer *renderer) {
    FramewrightTexels texels;
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_read(renderer, "screen", &texels));
    return (uint32_t)texels.bytes[0] << 16 | (uint32_t)texels.bytes[1] << 8 | texels.bytes[2];
}

int main(void) {
    write_file("sets.ron", PIPELINE);
    write_file("tint.frag", SHADER);
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

    /* Red, 256 bytes behind it green, and again as far behind it the address of green. */
    int addresses = v1_2.bufferDeviceAddress;
    VkBufferCreateInfo buffer_info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 768, .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT};
    if (addresses) {
        buffer_info.usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    }
    VkBuffer buffer;
    vk(vkCreateBuffer(raw, &buffer_info, NULL, &buffer));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(raw, buffer, &needs);
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(physical, &types);
    const VkMemoryPropertyFlags mapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkMemoryAllocateFlagsInfo memory_flags = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    VkMemoryAllocateInfo memory_info = {
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, addresses ? &memory_flags : NULL, needs.size, 0};
    while (!(needs.memoryTypeBits >> memory_info.memoryTypeIndex & 1)
           || (types.memoryTypes[memory_info.memoryTypeIndex].propertyFlags & mapped) != mapped) {
        ++memory_info.memoryTypeIndex;
    }
    VkDeviceMemory memory;
    vk(vkAllocateMemory(raw, &memory_info, NULL, &memory));
    vk(vkBindBufferMemory(raw, buffer, memory, 0));
    void *bytes;
    vk(vkMapMemory(raw, memory, 0, VK_WHOLE_SIZE, 0, &bytes));
    const float red[4] = {1, 0, 0, 1}, green[4] = {0, 1, 0, 1};
    memcpy(bytes, red, sizeof red);
    memcpy((char *)bytes + 256, green, sizeof green);
    if (addresses) {
        VkBufferDeviceAddressInfo address_info = {VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, NULL, buffer};
        VkDeviceAddress address = vkGetBufferDeviceAddress(raw, &address_info) + 256;
        memcpy((char *)bytes + 512, &address, sizeof address);
    }

    /* The program's set. */
    VkDescriptorSetLayoutBinding binding = {
        1, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1, VK_SHADER_STAGE_FRAGMENT_BIT, NULL};
    VkDescriptorSetLayoutCreateInfo layout_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 1, .pBindings = &binding};
    VkDescriptorSetLayout layout;
    vk(vkCreateDescriptorSetLayout(raw, &layout_info, NULL, &layout));
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 1};
    VkDescriptorPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, NULL, 0, 1, 1, &size};
    VkDescriptorPool pool;
    vk(vkCreateDescriptorPool(raw, &pool_info, NULL, &pool));
    VkDescriptorSetAllocateInfo set_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, NULL, pool, 1, &layout};
    VkDescriptorSet set;
    vk(vkAllocateDescriptorSets(raw, &set_info, &set));
    VkDescriptorBufferInfo tint = {buffer, 0, 16};
    VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, .dstSet = set, .dstBinding = 1, .descriptorCount = 1,
        .descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, .pBufferInfo = &tint};
    vkUpdateDescriptorSets(raw, 1, &write, 0, NULL);

    FramewrightSet told = {.set = 3, .bindings = &binding, .binding_count = 1};
    FramewrightRendererOptions options = {.struct_size = sizeof options, .sets = &told, .set_count = 1};
    for (int with_layout = 0; with_layout < 2; ++with_layout) {
        told.layout = with_layout ? layout : VK_NULL_HANDLE;
        FramewrightRenderer *renderer;
        check(framewright_renderer_open(device, "sets.ron", &options, &renderer));
        check(framewright_renderer_set_extent(renderer, 4, 4));
        const char *unbound = "a draw without set 3, which the program binds itself";
        FAILS(framewright_renderer_frame(renderer, NULL), MISUSE, unbound);
        uint32_t offset = 0;
        FAILS(framewright_renderer_bind_set(renderer, 3, set, NULL, 1), MISUSE, "`offsets` is NULL");
        check(framewright_renderer_bind_set(renderer, 3, set, NULL, 0));
        FAILS(framewright_renderer_frame(renderer, NULL), MISUSE, "takes 1 dynamic offsets and was given 0");
        check(framewright_renderer_bind_set(renderer, 3, set, &offset, 1));
        /* A number that no set has is told, and nothing is drawn until it is let go. */
        check(framewright_renderer_bind_set(renderer, 2, set, &offset, 1));
        FAILS(framewright_renderer_frame(renderer, NULL), MISUSE, "set 2 is bound, and the program has told of none");
        check(framewright_renderer_bind_set(renderer, 2, VK_NULL_HANDLE, NULL, 0));
        uint32_t first = drawn(renderer);
        offset = 256;
        check(framewright_renderer_bind_set(renderer, 3, set, &offset, 1));
        /* A new Plan keeps it. */
        check(framewright_renderer_set_extent(renderer, 8, 8));
        uint32_t second = drawn(renderer);
        if (first != 0xff0000 || second != 0x00ff00) {
            fprintf(stderr, "drawn %06x and %06x\n", (unsigned)first, (unsigned)second);
            return EXIT_FAILURE;
        }
        check(framewright_renderer_bind_set(renderer, 3, VK_NULL_HANDLE, NULL, 0));
        FAILS(framewright_renderer_frame(renderer, NULL), MISUSE, unbound);
        framewright_renderer_free(renderer);
    }

    /* Addresses are followed where the program says so. */
    FramewrightRenderer *none;
    write_file("tint.frag", FOLLOWS);
    for (uint32_t said = 0; said < 2 && addresses; ++said) {
        options.addresses = said;
        check(framewright_renderer_open(device, "sets.ron", &options, &none));
        check(framewright_renderer_set_extent(none, 4, 4));
        uint32_t offset = 512;
        check(framewright_renderer_bind_set(none, 3, set, &offset, 1));
        if (!said) {
            FAILS(framewright_renderer_frame(none, NULL), MISTAKES, "no program says that it hands addresses out");
        } else if (drawn(none) != 0x00ff00) {
            return EXIT_FAILURE;
        }
        framewright_renderer_free(none);
    }
    options.addresses = 0;
    write_file("tint.frag", SHADER);

    /* What doesn't fit is told when the renderer is opened, or planned. */
    told = (FramewrightSet){.set = 1, .bindings = &binding, .binding_count = 1};
    FAILS(framewright_renderer_open(device, "sets.ron", &options, &none), MISUSE, "set 1 is the draw source's");
    told.set = 3;
    VkDescriptorSetLayoutBinding wrong = binding;
    told.bindings = &wrong;
    wrong.stageFlags = VK_SHADER_STAGE_ALL;
    FAILS(framewright_renderer_open(device, "sets.ron", &options, &none), MISUSE, "is for other stages");
    wrong = binding;
    wrong.descriptorType = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
    FAILS(framewright_renderer_open(device, "sets.ron", &options, &none), MISUSE, "a type that no set of a program has");
    wrong = binding;
    VkSampler sampler = VK_NULL_HANDLE;
    wrong.pImmutableSamplers = &sampler;
    FAILS(framewright_renderer_open(device, "sets.ron", &options, &none), MISUSE, "has immutable samplers");
    wrong = binding;
    VkDescriptorBindingFlags flags = 1u << 30;
    told.flags = &flags;
    FAILS(framewright_renderer_open(device, "sets.ron", &options, &none), MISUSE, "flags that aren't known");
    told.flags = NULL;
    wrong.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    check(framewright_renderer_open(device, "sets.ron", &options, &none));
    FAILS(framewright_renderer_frame(none, NULL), MISTAKES, "[E0829]");
    framewright_renderer_free(none);

    framewright_device_free(device);
    vkDestroyDescriptorPool(raw, pool, NULL);
    vkDestroyDescriptorSetLayout(raw, layout, NULL);
    vkDestroyBuffer(raw, buffer, NULL);
    vkFreeMemory(raw, memory, NULL);
    vkDestroyDevice(raw, NULL);
    vkDestroyInstance(instance, NULL);
    return EXIT_SUCCESS;
}
