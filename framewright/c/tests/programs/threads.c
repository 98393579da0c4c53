/* Threads of a program in C record secondary command buffers, which a custom pass executes within its rendering scope. The device is the
 * program's own. Writes picture.ppm. */

#include "testing.h"
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
    write_file("threads.ron", PIPELINE);
    OwnDevice own;
    open_vulkan(&own);
    open_device(&own, NULL);

    Program program = {.executed = 0};
    for (int number = 0; number < THREADS; ++number) {
        Thread *thread = &program.threads[number];
        thread->device = own.raw;
        thread->number = number;
        VkCommandPoolCreateInfo pool = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL, 0, own.queue.family};
        vk(vkCreateCommandPool(own.raw, &pool, NULL, &thread->pool));
        VkCommandBufferAllocateInfo allocate = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, thread->pool,
                                                VK_COMMAND_BUFFER_LEVEL_SECONDARY, 1};
        vk(vkAllocateCommandBuffers(own.raw, &allocate, &thread->commands));
    }
    FramewrightRenderer *renderer;
    check(framewright_renderer_open(own.device, "threads.ron", NULL, &renderer));
    check(framewright_renderer_set_extent(renderer, 320, 180));
    check(framewright_renderer_set_recorder(renderer, record, &program));
    check(framewright_renderer_set_secondary(renderer, "columns", 1));
    check(framewright_renderer_inheritance(renderer, "columns", &program.told));
    FAILS(framewright_renderer_inheritance(renderer, "fill", &program.told), MISUSE, "no rendering scope has a pass");
    check(framewright_renderer_frame(renderer, NULL));
    check(framewright_renderer_frame(renderer, NULL));

    FramewrightTexels texels;
    check(framewright_renderer_read(renderer, "screen", &texels));
    write_picture(&texels);
    framewright_renderer_free(renderer);
    for (int number = 0; number < THREADS; ++number) {
        vkDestroyCommandPool(own.raw, program.threads[number].pool, NULL);
    }
    close_device(&own);
    close_vulkan(&own);
    return program.executed == 2 ? EXIT_SUCCESS : EXIT_FAILURE;
}
