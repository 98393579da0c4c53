/* Threads of a program in C record secondary command buffers, which a custom pass executes within its rendering scope. The device is the
 * program's own. Writes picture.ppm. */

#include <framewright.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

enum { THREADS = 4 };

/* `show`, `columns` and `last` share a rendering scope. */
static const char PIPELINE[] =
    "Pipeline(version: 1,\n"
    "    images: [(name: \"mine\", format: R8G8B8A8_UNORM, size: Output), (name: \"screen\", format: R8G8B8A8_UNORM, size: Output)],\n"
    "    passes: [(name: \"fill\", custom: \"fill\", writes: [\"mine\"]),\n"
    "        (name: \"show\", draw: FullScreen(\"copy\"), sample: {\"source\": \"mine\"}, color: [\"screen\"]),\n"
    "        (name: \"columns\", custom: \"columns\", color: [\"screen\"]),\n"
    "        (name: \"last\", custom: \"last\", color: [\"screen\"])],\n"
    "    outputs: [\"screen\"])\n";

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

/* A thread's own command pool, with a command buffer that it records. */
typedef struct {
    VkDevice device;
    VkCommandPool pool;
    VkCommandBuffer commands;
    const VkCommandBufferInheritanceRenderingInfo *scope;
    int number;
} Thread;

typedef struct {
    Thread threads[THREADS];
    VkCommandBufferInheritanceRenderingInfo told;
    int executed;
} Program;

/* Each thread has forty columns and a colour. */
static int record_columns(void *context) {
    static const VkClearColorValue COLORS[THREADS] = {
        {.float32 = {1, 0, 0, 1}}, {.float32 = {0, 1, 0, 1}}, {.float32 = {1, 1, 0, 1}}, {.float32 = {1, 1, 1, 1}}};
    Thread *thread = context;
    VkCommandBufferInheritanceInfo inherited = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO, .pNext = thread->scope};
    VkCommandBufferBeginInfo begin = {
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, NULL, VK_COMMAND_BUFFER_USAGE_RENDER_PASS_CONTINUE_BIT, &inherited};
    VkClearAttachment color = {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = COLORS[thread->number]}};
    VkClearRect columns = {{{40 * thread->number, 0}, {40, 180}}, 0, 1};
    vk(vkResetCommandPool(thread->device, thread->pool, 0));
    vk(vkBeginCommandBuffer(thread->commands, &begin));
    vkCmdClearAttachments(thread->commands, 1, &color, 1, &columns);
    vk(vkEndCommandBuffer(thread->commands));
    return 0;
}

/* What a pass accesses is told to any thread. */
static int ask(void *context) {
    const FramewrightPass *pass = context;
    const char *name = pass->in_scope ? "screen" : "mine";
    for (int times = 0; times < 100; ++times) {
        FramewrightPassImage image;
        check(framewright_pass_image(pass, name, &image));
        VkBuffer buffer;
        if (image.image == VK_NULL_HANDLE || framewright_pass_buffer(pass, name, &buffer) != FRAMEWRIGHT_STATUS_MISUSE) {
            return 1;
        }
    }
    return 0;
}

/* Whether all threads are told. */
static int ask_at_once(const FramewrightPass *pass) {
    thrd_t started[THREADS];
    int wrong = 0;
    for (int number = 0; number < THREADS; ++number) {
        if (thrd_create(&started[number], ask, (void *)pass) != thrd_success) {
            exit(EXIT_FAILURE);
        }
    }
    for (int number = 0; number < THREADS; ++number) {
        int found;
        thrd_join(started[number], &found);
        wrong += found;
    }
    return wrong == 0;
}

static uint32_t record(void *context, const FramewrightPass *pass) {
    Program *program = context;
    if (!ask_at_once(pass)) {
        return 0;
    }
    if (strcmp(pass->custom, "last") == 0) {
        return pass->in_scope && pass->inheritance == NULL;
    }
    if (!pass->in_scope) {
        FramewrightPassImage image;
        VkClearColorValue blue = {.float32 = {0, 0, 1, 1}};
        check(framewright_pass_image(pass, "mine", &image));
        vkCmdClearColorImage(pass->commands, image.image, image.layout, &blue, 1, &image.range);
        return pass->inheritance == NULL;
    }
    const VkCommandBufferInheritanceRenderingInfo *scope = pass->inheritance;
    if (scope == NULL || scope->colorAttachmentCount != 1 || scope->rasterizationSamples != VK_SAMPLE_COUNT_1_BIT ||
        scope->pColorAttachmentFormats[0] != VK_FORMAT_R8G8B8A8_UNORM || scope->flags != program->told.flags ||
        program->told.pColorAttachmentFormats[0] != VK_FORMAT_R8G8B8A8_UNORM) {
        return 0;
    }
    thrd_t started[THREADS];
    VkCommandBuffer recorded[THREADS];
    for (int number = 0; number < THREADS; ++number) {
        Thread *thread = &program->threads[number];
        /* Every second thread records by what was told before the frame. */
        thread->scope = number % 2 == 0 ? scope : &program->told;
        recorded[number] = thread->commands;
        if (thrd_create(&started[number], record_columns, thread) != thrd_success) {
            return 0;
        }
    }
    for (int number = 0; number < THREADS; ++number) {
        thrd_join(started[number], NULL);
    }
    vkCmdExecuteCommands(pass->commands, THREADS, recorded);
    ++program->executed;
    return 1;
}

int main(void) {
    FILE *file = fopen("threads.ron", "wb");
    fputs(PIPELINE, file);
    fclose(file);
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
    FramewrightAdoptedDevice adopted = {
        .struct_size = sizeof adopted, .instance = instance, .physical_device = physical, .device = raw,
        .features = &features, .queues = &queue, .queue_count = 1};
    FramewrightDevice *device;
    check(framewright_device_adopt(&adopted, &device));

    Program program = {.executed = 0};
    for (int number = 0; number < THREADS; ++number) {
        Thread *thread = &program.threads[number];
        thread->device = raw;
        thread->number = number;
        VkCommandPoolCreateInfo pool = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, queue.family};
        vk(vkCreateCommandPool(raw, &pool, NULL, &thread->pool));
        VkCommandBufferAllocateInfo allocate = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, thread->pool,
                                                VK_COMMAND_BUFFER_LEVEL_SECONDARY, 1};
        vk(vkAllocateCommandBuffers(raw, &allocate, &thread->commands));
    }
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(device, "threads.ron", NULL, &renderer));
    check(framewright_renderer_set_extent(renderer, 320, 180));
    check(framewright_renderer_set_recorder(renderer, record, &program));
    check(framewright_renderer_set_secondary(renderer, "columns", 1));
    check(framewright_renderer_inheritance(renderer, "columns", &program.told));
    if (framewright_renderer_inheritance(renderer, "fill", &program.told) != FRAMEWRIGHT_STATUS_MISUSE) {
        fprintf(stderr, "`fill` stands in no scope\n");
        return EXIT_FAILURE;
    }
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_frame(renderer, NULL));

    FramewrightTexels texels;
    check(framewright_renderer_read(renderer, "screen", &texels));
    file = fopen("picture.ppm", "wb");
    fprintf(file, "P6\n%u %u\n255\n", texels.width, texels.height);
    for (size_t at = 0; at + 4 <= texels.byte_count; at += 4) {
        fwrite(texels.bytes + at, 1, 3, file);
    }
    fclose(file);
    framewright_renderer_free(renderer);
    framewright_device_free(device);
    for (int number = 0; number < THREADS; ++number) {
        vkDestroyCommandPool(raw, program.threads[number].pool, NULL);
    }
    vkDestroyDevice(raw, NULL);
    vkDestroyInstance(instance, NULL);
    return program.executed == 2 ? EXIT_SUCCESS : EXIT_FAILURE;
}
