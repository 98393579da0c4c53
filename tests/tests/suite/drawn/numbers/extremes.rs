//! The table of extremes: what, the result, and the test that shows it.

pub(super) const EXTREMES: [(&str, &str, &str); 35] = [
    (
        "near 10⁻⁴ m and far 10⁸ m in `D32_SFLOAT`, reversed, with a far plane or without",
        "surfaces 1/64 of their distance apart are told apart at every distance",
        "drawn::extremes::depth_ranges::reversed_floating_point_depth_tells_all_distances_apart_and_no_other_depth_does",
    ),
    (
        "the same in `D16_UNORM`, `X8_D24_UNORM_PACK32`, or with standard depth in any format",
        "they are told apart up to 0.02 m with 16 bits and 6 m with 24; standard depth in `D32_SFLOAT` is no better than 24 bits",
        "drawn::extremes::depth_ranges::reversed_floating_point_depth_tells_all_distances_apart_and_no_other_depth_does",
    ),
    (
        "a far plane",
        "depth and distances are those of the twin; nothing beyond is drawn",
        "drawn::far_plane::depth_and_stripes_are_their_twins_and_nothing_beyond_is_drawn",
    ),
    (
        "a far plane close behind the scene",
        "the picture is that without one",
        "drawn::far_plane::what_is_made_of_depth_is_the_same_with_a_far_plane_close_behind_the_scene",
    ),
    (
        "a far plane, seen by two eyes 20 m apart",
        "each eye's picture is that without one",
        "drawn::stereo::cameras::a_far_plane_changes_nothing_of_what_each_eye_sees_before_it",
    ),
    (
        "a scene 10⁶ m from its origin",
        "the picture is that at the origin",
        "drawn::far_away::a_scene_a_million_metres_away_is_drawn_as_near_its_origin",
    ),
    (
        "eyes 10⁶ m from the origin",
        "each sees what it sees at the origin",
        "drawn::stereo::cameras::eyes_far_from_the_origin_see_what_they_see_near_it",
    ),
    (
        "eyes at one place, and 1,000 m apart",
        "the same picture bit by bit; what a camera in each place sees",
        "drawn::stereo::cameras::eyes_at_one_place_and_a_kilometre_apart_see_what_a_camera_there_sees",
    ),
    (
        "pictures of 1 × 1, 1 × N and N × 1, also of a quarter of a pixel",
        "each pixel has the value that it has in a large picture",
        "drawn::extremes::sizes::pictures_of_one_pixel_row_or_column_hold_what_large_ones_hold",
    ),
    (
        "the shipped pipelines at 1 × 1, 1 × 5 and 5 × 1",
        "all pixels alike; where snow falls the sky, or what is brighter",
        "drawn::extremes::sizes::every_shipped_pipeline_draws_pictures_of_one_pixel",
    ),
    (
        "the filters of the final scale at 1 × 1, 1 × 9 and 9 × 1, scales 0.25 to 4",
        "as at any size",
        "drawn::scale::the_area_filter_is_the_mean_of_what_a_pixel_covers_at_every_scale",
    ),
    (
        "images as wide or as high as the device can draw, and both",
        "every texel is drawn and read back; a texel more is an error that names the image and the limit",
        "drawn::extremes::sizes::the_largest_images_hold_each_texel_and_larger_ones_are_refused",
    ),
    (
        "light of 0, −0, denormals, 65,504, 65,520, 10⁶, 10³⁸, ±∞, NaN and below 0, stored in every format of colour",
        "0 to the largest number of the format; NaN and what is negative are 0",
        "drawn::extremes::blending::every_format_of_colour_holds_guarded_light_up_to_its_largest_number",
    ),
    (
        "the same in the plain average of four samples, also of half floats",
        "their mean: 65,504 four times is 65,504",
        "drawn::extremes::blending::the_plain_average_of_samples_is_their_mean_up_to_the_largest_half",
    ),
    (
        "the same in blends",
        "their sum where a half float holds it; beyond that 65,504, or 0 where the driver stores NaN, as SwiftShader does",
        "drawn::extremes::blending::blends_are_read_as_their_sum_as_far_as_a_half_float_holds_it",
    ),
    (
        "the same unguarded, as a user's shader may store it, in half floats and in 32 bits",
        "as they are where a half float holds them; else 65,504, or 0 where the driver stores NaN; nothing that isn't finite is read",
        "drawn::extremes::blending::unguarded_numbers_are_read_as_they_are_or_as_the_largest_or_0",
    ),
    (
        "the same unguarded in the plain average of four samples",
        "their mean where a half float holds all of them; else something finite",
        "drawn::extremes::blending::unguarded_samples_are_averaged_or_leave_something_finite",
    ),
    (
        "the same unguarded in blends",
        "their sum where a half float holds it; else 65,504, or 0 where the driver stores NaN",
        "drawn::extremes::blending::unguarded_sums_are_read_as_they_are_or_as_the_largest_or_0",
    ),
    (
        "the same in resolves that weigh or tone-map samples",
        "the twin's mean of guarded samples",
        "drawn::resolves::a_weighted_resolve_is_the_mean_of_tone_mapped_samples_taken_back",
    ),
    (
        "the same in filters",
        "the twin's result of guarded texels",
        "drawn::shipped_numbers::filters::a_blur_of_infinite_texels_is_bright_and_of_what_is_no_number_black",
    ),
    (
        "the same in filters of the device",
        "guarded texels are mixed",
        "drawn::shipped_numbers::scales::a_linear_filter_at_twice_the_size_mixes_guarded_texels",
    ),
    (
        "the same in bloom",
        "0 to 65,504; nothing spreads over the image",
        "drawn::bloom::infinities_and_what_is_no_number_leave_no_trace",
    ),
    (
        "the same in every shader that fills the screen",
        "what is stored is finite",
        "drawn::shipped_numbers::full_screen::every_shipped_full_screen_shader_stores_finite_numbers_whatever_its_images_hold",
    ),
    (
        "the same in materials, normals and lights",
        "what is stored is finite",
        "drawn::shipped_numbers::scenes::every_other_shipped_shader_stores_finite_numbers_whatever_materials_and_lights_hold",
    ),
    (
        "every half float, and numbers up to 10³⁸, in every tone mapper",
        "0 to 1; 0 stays 0",
        "drawn::tone_mapping_operators::whatever_goes_in_every_operator_gives_zero_to_one_and_leaves_zero_at_zero",
    ),
    (
        "white points 1, 1 + 10⁻⁷, 100 and 10³⁰",
        "the twin's curve",
        "drawn::tone_mapping::tone_mapping_on_the_gpu_is_its_twin",
    ),
    (
        "the same in HDR10",
        "a signal of 0 to 1",
        "drawn::hdr10::whatever_goes_in_a_signal_between_zero_and_one_comes_out",
    ),
    (
        "triangles without area, and transforms with scales of 0",
        "the picture is that without them, bit by bit",
        "drawn::extremes::shapes::what_has_no_area_leaves_no_trace",
    ),
    (
        "a needle of 100 m by 0.1 mm",
        "each pixel shows its own light or nothing of it",
        "drawn::extremes::shapes::a_needle_shows_its_own_light_or_nothing",
    ),
    (
        "normals of length 0, and so short that their square is 0",
        "ambient and emitted light",
        "drawn::extremes::shapes::surfaces_without_a_normal_show_ambient_and_emitted_light",
    ),
    (
        "0, 1 and 4,096 point lights of 0 to 10⁶",
        "the twin's sum, at most 65,504",
        "drawn::extremes::lights::no_lights_and_very_many_give_their_sum_and_more_are_refused",
    ),
    (
        "10,000 point lights",
        "an error that tells how many can be drawn",
        "drawn::extremes::lights::no_lights_and_very_many_give_their_sum_and_more_are_refused",
    ),
    (
        "ten blurs of one texel of 65,504",
        "the twin's picture; no light is added or lost",
        "drawn::extremes::lights::ten_blurs_of_one_hot_texel_keep_its_light",
    ),
    (
        "stripes by distances that 32 bits don't tell apart",
        "none",
        "drawn::depth_stripes::stripes_that_can_not_be_told_apart_are_none",
    ),
    (
        "a near plane 10⁻⁶ m away, and formats that the file wants coarse",
        "a finer format is taken, and a note says so",
        "drawn::image_quality::formats::coarse_depth_loses_nothing_however_near_the_near_plane_is",
    ),
];
