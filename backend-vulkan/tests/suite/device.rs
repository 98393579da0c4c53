//! Opening devices, and resources that come and go.

use crate::testing;
use framewright_graph::device::{ImageDescriptor, MemoryProvider};
use framewright_graph::shader::{DrawInterface, SuppliedKind, SuppliedResource};
use framewright_graph::vulkan::{Format, Shape, Sharing, Usage};
use framewright_vulkan::{
    BindGroup, BufferUsage, Device, DeviceChoice, DeviceOptions, Error, Executor, Resource, SamplerDescriptor, Texture,
    minimum_features,
};

/// A program may draw in a thread of its own and upload in others.
const _: () = {
    const fn goes_to_threads<T: Send + Sync>() {}
    goes_to_threads::<Device>();
    goes_to_threads::<Executor>();
    goes_to_threads::<Texture>();
    goes_to_threads::<BindGroup>();
};

#[test]
fn buffers_textures_and_bind_groups_come_and_go_in_silence() {
    let Some(device) = testing::open() else { return };
    let messages = device.messages();
    let interface = DrawInterface {
        supplied: vec![
            SuppliedResource::new(1, 0, "view", SuppliedKind::UniformBlock),
            SuppliedResource::new(1, 1, "objects", SuppliedKind::StorageBlock),
            SuppliedResource::new(1, 2, "base_color_texture", SuppliedKind::SampledImage),
        ],
        ..DrawInterface::default()
    };
    let view = device.buffer(BufferUsage::Uniform, &[1; 64]).expect("a uniform buffer");
    let objects = device.buffer(BufferUsage::Storage, &[]).expect("an empty storage buffer");
    let texels = [255; 5 * 3 * 4];
    let texture = device
        .texture(5, 3, Format::R8G8B8A8_SRGB, &texels, &SamplerDescriptor::default(), true)
        .expect("a texture with mips");
    let group = device.bind_group(
        &interface,
        1,
        &[(0, Resource::Buffer(&view)), (1, Resource::Buffer(&objects)), (2, Resource::Texture(&texture))],
    );
    drop((view, objects, texture));
    let group = group.expect("a bind group");
    drop(device);
    drop(group);
    assert_eq!(testing::findings(&messages), []);
}

#[test]
fn the_layer_is_given_only_settings_that_it_knows() {
    let Some(device) = testing::open() else { return };
    let about_settings = |text: &str| text.contains("VkLayerSettingsCreateInfoEXT");
    let said: Vec<_> = device.messages().list().into_iter().filter(|message| about_settings(&message.text)).collect();
    assert_eq!(said, []);
}

#[test]
fn a_bind_group_refuses_what_its_interface_does_not_name() {
    let Some(device) = testing::device() else { return };
    let view = SuppliedResource::new(1, 0, "view", SuppliedKind::UniformBlock);
    let interface = DrawInterface { supplied: vec![view], ..DrawInterface::default() };
    let buffer = device.buffer(BufferUsage::Storage, &[0; 16]).expect("a buffer");
    let message = |set, resources: &[(u32, Resource<'_>)]| match device.bind_group(&interface, set, resources) {
        Ok(_) => "no error".to_owned(),
        Err(error) => error.to_string(),
    };
    let given = Resource::Buffer(&buffer);
    assert_eq!(message(1, &[]), "bind group for set 1: `view` is needed once and was given 0 times");
    assert_eq!(message(1, &[(3, given)]), "bind group for set 1: the draw interface has no binding 3");
    assert_eq!(
        message(1, &[(0, given)]),
        "bind group for set 1: `view` is a uniform block, and something else was given"
    );
    assert_eq!(message(0, &[]), "bind group for set 0: it belongs to the pass");
}

#[test]
fn a_texture_refuses_bytes_that_do_not_fit_its_extent() {
    let Some(device) = testing::device() else { return };
    let texture = |width, bytes: &[u8]| {
        device.texture(width, 1, Format::R8G8B8A8_UNORM, bytes, &SamplerDescriptor::default(), false).err()
    };
    let short = texture(2, &[0; 7]).expect("refused").to_string();
    assert_eq!(short, "texture of 2 × 1 R8G8B8A8_UNORM: 7 bytes were given, 8 are needed");
    assert!(matches!(texture(0, &[]), Some(Error::BadResource { .. })));
}

#[test]
fn an_unknown_device_name_suggests_a_near_one() {
    let Some(device) = testing::device() else { return };
    let first_word = device.summary().name.split(' ').next().expect("a name").to_owned();
    let wrong = first_word.replacen(first_word.chars().nth(1).expect("two letters"), "x", 1);
    let options = DeviceOptions { choice: DeviceChoice::Name(wrong), ..DeviceOptions::default() };
    match Device::open(&options).err() {
        Some(Error::UnknownDevice { near: Some(near), .. }) => assert_eq!(near, device.summary().name),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_device_is_found_by_number_by_name_and_by_part_of_its_name() {
    let Some(device) = testing::device() else { return };
    let summary = device.summary();
    let part = summary.name[1..5].to_uppercase();
    for choice in
        [DeviceChoice::Index(summary.index), DeviceChoice::Name(summary.name.clone()), DeviceChoice::Name(part)]
    {
        let opened = Device::open(&DeviceOptions { choice, ..DeviceOptions::default() }).expect("it is there");
        assert_eq!(opened.summary().name, summary.name);
    }
    let beyond = DeviceOptions { choice: DeviceChoice::Index(99), ..DeviceOptions::default() };
    assert!(matches!(Device::open(&beyond).err(), Some(Error::UnknownDevice { .. })));
}

#[test]
fn a_live_profile_knows_what_every_vulkan_device_can() {
    let Some(device) = testing::device() else { return };
    let profile = device.profile();
    assert!(profile.max_attachment_extent >= 4096);
    assert!(profile.max_color_attachments >= 4);
    let color = profile.format(Format::R8G8B8A8_UNORM).expect("a mandatory format");
    assert!(color.usage.contains(Usage::SAMPLED | Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC));
    assert!(color.linear_filter && color.blend && color.samples.contains(&1) && color.samples.contains(&4));
    let depth = profile.format(Format::D16_UNORM).expect("a mandatory format");
    assert!(depth.usage.contains(Usage::DEPTH_STENCIL_ATTACHMENT) && !depth.usage.contains(Usage::COLOR_ATTACHMENT));
    assert!(profile.memory.alignment.is_power_of_two());
}

#[test]
fn live_memory_needs_are_exact_and_grow_with_samples() {
    let Some(device) = testing::device() else { return };
    let mut memory = device.memory();
    assert!(memory.exact());
    let mut descriptor = ImageDescriptor {
        format: Format::R16G16B16A16_SFLOAT,
        shape: Shape::D2,
        extent: [64, 64, 1],
        mips: 1,
        layers: 1,
        samples: 1,
        usage: Usage::COLOR_ATTACHMENT,
        sharing: Sharing::Exclusive,
    };
    let single = memory.image(&descriptor);
    descriptor.samples = 4;
    let multisampled = memory.image(&descriptor);
    assert!(single.bytes >= 64 * 64 * 8 && multisampled.bytes >= 4 * 64 * 64 * 8);
}

#[test]
fn the_stated_minimum_is_the_one_that_is_checked() {
    let stated = include_str!("../../src/lib.rs").split("# The minimum device").nth(1).expect("it is stated");
    let stated = stated.split("# Validation").next().expect("it ends");
    for feature in minimum_features() {
        assert!(stated.contains(&format!("`{feature}`")), "{feature} is not stated");
    }
}
