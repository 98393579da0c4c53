/* A descriptor set that a program in C makes and binds itself: a colour in a uniform buffer, at two dynamic offsets. Writes nothing. */

#include "testing.h"

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
    OwnDevice own;
    open_vulkan(&own);
    open_device(&own, NULL);
    VkDevice raw = own.raw;

    /* Red, 256 bytes behind it green, and again as far behind it the address of green. */
    VkPhysicalDeviceVulkan12Features v1_2 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v1_2};
    vkGetPhysicalDeviceFeatures2(own.physical, &features);
    int addresses = v1_2.bufferDeviceAddress;
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    if (addresses) {
        usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    }
    OwnBuffer colors = own_buffer(&own, usage, 768);
    VkBuffer buffer = colors.buffer;
    void *bytes = colors.bytes;
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
        check(framewright_renderer_open(own.device, "sets.ron", &options, &renderer));
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
        check(framewright_renderer_open(own.device, "sets.ron", &options, &none));
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
    FAILS(framewright_renderer_open(own.device, "sets.ron", &options, &none), MISUSE, "set 1 is the draw source's");
    told.set = 3;
    VkDescriptorSetLayoutBinding wrong = binding;
    told.bindings = &wrong;
    wrong.stageFlags = VK_SHADER_STAGE_ALL;
    FAILS(framewright_renderer_open(own.device, "sets.ron", &options, &none), MISUSE, "is for other stages");
    wrong = binding;
    wrong.descriptorType = VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT;
    FAILS(framewright_renderer_open(own.device, "sets.ron", &options, &none), MISUSE, "a type that no set of a program has");
    wrong = binding;
    VkSampler sampler = VK_NULL_HANDLE;
    wrong.pImmutableSamplers = &sampler;
    FAILS(framewright_renderer_open(own.device, "sets.ron", &options, &none), MISUSE, "has immutable samplers");
    wrong = binding;
    VkDescriptorBindingFlags flags = 1u << 30;
    told.flags = &flags;
    FAILS(framewright_renderer_open(own.device, "sets.ron", &options, &none), MISUSE, "flags that aren't known");
    told.flags = NULL;
    wrong.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    check(framewright_renderer_open(own.device, "sets.ron", &options, &none));
    FAILS(framewright_renderer_frame(none, NULL), MISTAKES, "[E0829]");
    framewright_renderer_free(none);

    vkDestroyDescriptorPool(raw, pool, NULL);
    vkDestroyDescriptorSetLayout(raw, layout, NULL);
    free_buffer(&own, colors);
    close_device(&own);
    close_vulkan(&own);
    return EXIT_SUCCESS;
}
