/* Passes that don't run in every frame: what the program says of them. */

#include "testing.h"

static FramewrightRenderer *renderer;
static uint32_t drawn;

/* Counts how often the custom pass runs. */
static uint32_t record(void *context, const FramewrightPass *pass) {
    (void)context;
    (void)pass;
    return ++drawn;
}

static uint32_t runs(void) {
    drawn = 0;
    check(framewright_renderer_frame(renderer, NULL));
    return drawn;
}

int main(int count, char **arguments) {
    HOLDS(count == 2);
    FramewrightDevice *device;
    check(framewright_device_open(NULL, &device));
    check(framewright_renderer_open(device, arguments[1], NULL, &renderer));
    check(framewright_renderer_set_recorder(renderer, record, NULL));
    check(framewright_renderer_set_extent(renderer, 16, 16));
    HOLDS(runs() == 1 && runs() == 0);
    check(framewright_renderer_set_dirty(renderer, "sky"));
    HOLDS(runs() == 1 && runs() == 0);
    HOLDS(framewright_renderer_set_dirty(renderer, "ground") == FRAMEWRIGHT_STATUS_MISUSE);
    HOLDS(strstr(framewright_last_error(), "no pass runs when `ground` is dirty; passes wait for `sky`") != NULL);
    HOLDS(framewright_renderer_set_dirty(renderer, NULL) != FRAMEWRIGHT_STATUS_OK);
    check(framewright_renderer_run_all(renderer));
    HOLDS(runs() == 1 && runs() == 0);

    /* A resize. */
    check(framewright_renderer_set_extent(renderer, 32, 16));
    HOLDS(runs() == 1 && runs() == 0);

    /* Each third frame, by the program's own numbers. */
    check(framewright_renderer_set(renderer, "rare", "true"));
    HOLDS(runs() == 1);
    check(framewright_renderer_set_frame_number(renderer, 100));
    HOLDS(runs() == 0 && runs() == 0 && runs() == 1 && runs() == 0);

    framewright_renderer_free(renderer);
    framewright_device_free(device);
    return EXIT_SUCCESS;
}
