//! The validation layer: its messages, collected as data, and the settings that make it look closely.

use super::words::{text, version};
use ash::ext::{self, validation_features};
use ash::vk;
use std::borrow::Cow;
use std::collections::HashMap;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::thread::ThreadId;

/// Name of the layer.
pub(crate) const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// How grave a message is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// May be a mistake.
    Warning,
    /// Breaks the specification.
    Error,
}

/// The subject of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MessageKind {
    /// The loader's or a driver's own matters.
    General,
    /// The specification's rules.
    Validation,
    /// Use that is right but slow.
    Performance,
}

/// One message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// How grave.
    pub severity: Severity,
    /// About what.
    pub kind: MessageKind,
    /// The rule's name (`VUID-…`, `SYNC-HAZARD-…`). It differs between versions of the layer.
    pub id: String,
    /// The layer's words.
    pub text: String,
    /// The step that was recorded, and its pass if it has several; `None` if the layer doesn't tell, as of what it finds when commands
    /// are submitted. A program that labels its own commands finds those labels too.
    pub at: Option<String>,
}

impl Message {
    /// Whether the message reports an error of this program. Performance warnings, messages about the layer's own settings,
    /// and known false reports are none.
    #[must_use]
    pub fn is_finding(&self) -> bool {
        self.kind == MessageKind::Validation
            && !self.is_about_settings()
            && !self.is_about_a_look_up()
            && !self.takes_a_fill_for_a_copy()
    }

    /// The layer's words, behind [`Message::at`] if that is known.
    #[must_use]
    pub fn located(&self) -> String {
        self.at.as_ref().map_or_else(|| self.text.clone(), |at| format!("{at}: {}", self.text))
    }

    /// Whether another message says the same of the same step: a layer says it of each draw, and with the handles at hand.
    fn repeats(&self, other: &Message) -> bool {
        (self.severity, self.kind, &self.id, &self.at) == (other.severity, other.kind, &other.id, &other.at)
            && without_handles(&self.text).eq(without_handles(&other.text))
    }

    /// Whether it is about the layer's settings, wherever they come from: this program, a file, the environment.
    fn is_about_settings(&self) -> bool {
        ["VALIDATION-SETTINGS", "WARNING-Setting-Limit-Adjusted"].contains(&&*self.id)
    }

    /// Whether it is about a function that was looked up for a device and is one of the instance. The loader and layers of
    /// drivers look up all that they know, NVIDIA's among them. This crate looks up none.
    fn is_about_a_look_up(&self) -> bool {
        self.id == "WARNING-vkGetDeviceProcAddr-device"
    }

    /// Whether it says that the layer has no setting of this name.
    fn says_unknown(&self, setting: &CStr) -> bool {
        let name = setting.to_string_lossy();
        let mut words = self.text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
        // "not recognize" in some versions, "not recognized" in others.
        self.is_about_settings() && self.text.contains("not recogni") && words.any(|word| word == name)
    }

    /// `vkCmdFillBuffer` runs in the stage CLEAR, and barriers name it so; older layers (1.3.239 is one) believe in COPY and
    /// report what waits for CLEAR as a hazard. Newer ones say `SYNC_CLEAR_TRANSFER_WRITE`.
    fn takes_a_fill_for_a_copy(&self) -> bool {
        let says = |part| self.text.contains(part);
        self.id.starts_with("SYNC-HAZARD-") && says("usage: SYNC_COPY_TRANSFER_WRITE") && says("vkCmdFillBuffer")
    }
}

/// The messages of one device, readable also after it is gone.
#[derive(Debug, Clone, Default)]
pub struct Messages(Arc<Mutex<MessageCollector>>);

#[derive(Debug, Default)]
struct MessageCollector {
    messages: Vec<Message>,
    /// While a thread plants mistakes, its messages go here.
    diverted: HashMap<ThreadId, Vec<Message>>,
}

impl Messages {
    /// All messages so far, those of the canary left out.
    #[must_use]
    pub fn list(&self) -> Vec<Message> {
        self.lock().messages.clone()
    }

    /// Messages that say different things, each with how often it was said. One mistake is said of each draw, frame after frame.
    #[must_use]
    pub fn distinct(&self) -> Vec<(Message, usize)> {
        let mut distinct: Vec<(Message, usize)> = Vec::new();
        // Repetitions mostly come one after the other.
        for message in &self.lock().messages {
            match distinct.iter_mut().rev().find(|(known, _)| message.repeats(known)) {
                Some((_, count)) => *count += 1,
                None => distinct.push((message.clone(), 1)),
            }
        }
        distinct
    }

    /// The messages that this thread causes while `work` runs, kept apart from the others.
    pub(crate) fn apart<T>(&self, work: impl FnOnce() -> T) -> (T, Vec<Message>) {
        let thread = thread::current().id();
        self.lock().diverted.insert(thread, Vec::new());
        let result = work();
        let diverted = self.lock().diverted.remove(&thread);
        (result, diverted.unwrap_or_default())
    }

    fn lock(&self) -> MutexGuard<'_, MessageCollector> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The pointer that the messenger hands to [`receive`]: valid as long as `self`.
    fn as_user_data(&self) -> *mut c_void {
        Arc::as_ptr(&self.0).cast_mut().cast()
    }

    /// How a messenger is created that collects into `self`, which must outlive it.
    pub(crate) fn messenger(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        use vk::DebugUtilsMessageSeverityFlagsEXT as Severity;
        use vk::DebugUtilsMessageTypeFlagsEXT as Type;
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::ERROR | Severity::WARNING)
            .message_type(Type::GENERAL | Type::VALIDATION | Type::PERFORMANCE)
            .pfn_user_callback(Some(receive))
            .user_data(self.as_user_data())
    }
}

/// The words of a text, without the numbers of handles.
fn without_handles(text: &str) -> impl Iterator<Item = &str> {
    text.split("0x").enumerate().map(|(at, part)| {
        let digits = if at == 0 { 0 } else { part.bytes().take_while(u8::is_ascii_hexdigit).count() };
        &part[digits..]
    })
}

/// Vulkan's callback.
///
/// # Safety
/// `data` must point to a valid message, and `user` must come from a living [`Messages`].
unsafe extern "system" fn receive(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the messenger was made with a pointer into a `Messages` that outlives it.
    let collected = unsafe { &*user.cast::<Mutex<MessageCollector>>().cast_const() };
    // SAFETY: Vulkan hands over a valid structure whose strings end in zero or are null.
    let (id, text) = unsafe { (lossy((*data).p_message_id_name), lossy((*data).p_message)) };
    let severity = if severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR) {
        Severity::Error
    } else {
        Severity::Warning
    };
    let kind = if types.contains(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION) {
        MessageKind::Validation
    } else if types.contains(vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE) {
        MessageKind::Performance
    } else {
        MessageKind::General
    };
    // SAFETY: as above.
    let at = unsafe { labels(&*data) };
    let message = Message { severity, kind, id: id.into_owned(), text: text.into_owned(), at };
    let mut collected = collected.lock().unwrap_or_else(PoisonError::into_inner);
    match collected.diverted.get_mut(&thread::current().id()) {
        Some(diverted) => diverted.push(message),
        None => collected.messages.push(message),
    }
    vk::FALSE
}

/// The labels of the command buffer that a message is about, the outermost first.
///
/// # Safety
/// The data must be a message's.
unsafe fn labels(data: &vk::DebugUtilsMessengerCallbackDataEXT<'_>) -> Option<String> {
    if data.p_cmd_buf_labels.is_null() || data.cmd_buf_label_count == 0 {
        return None;
    }
    // SAFETY: Vulkan hands over as many labels as it says, the innermost first, whose names end in zero or are null.
    let labels = unsafe { std::slice::from_raw_parts(data.p_cmd_buf_labels, data.cmd_buf_label_count as usize) };
    // SAFETY: as above.
    let names: Vec<_> = labels.iter().rev().map(|label| unsafe { lossy(label.p_label_name) }).collect();
    Some(names.join(", "))
}

/// # Safety
/// `text` must be null or point to a string that ends in zero and lives as long as the result is used.
unsafe fn lossy<'a>(text: *const std::ffi::c_char) -> Cow<'a, str> {
    if text.is_null() {
        return Cow::Borrowed("");
    }
    // SAFETY: the caller's promise.
    unsafe { CStr::from_ptr(text) }.to_string_lossy()
}

/// The validation layer that the loader found.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    /// Description and version, for people.
    pub(crate) shown: String,
    /// Whether it takes settings through `VK_EXT_layer_settings`: then it is of the generation that checks the
    /// synchronisation of dynamic rendering too.
    pub(crate) current: bool,
}

impl Layer {
    /// The layer, if the loader finds it.
    pub(crate) fn find(entry: &ash::Entry) -> Option<Layer> {
        // SAFETY: the loader is loaded.
        let layers = unsafe { entry.enumerate_instance_layer_properties() }.ok()?;
        let found = layers.iter().find(|layer| layer.layer_name_as_c_str() == Ok(LAYER))?;
        // SAFETY: the loader is loaded.
        let extensions = unsafe { entry.enumerate_instance_extension_properties(Some(LAYER)) }.unwrap_or_default();
        let current = extensions.iter().any(|it| it.extension_name_as_c_str() == Ok(ext::layer_settings::NAME));
        let version = version(found.spec_version);
        let description = text(found.description_as_c_str());
        Some(Layer { shown: format!("{description} ({version})"), current })
    }

    /// Extensions that come from the layer itself.
    pub(crate) fn extensions(&self) -> &'static [&'static CStr] {
        &[validation_features::NAME]
    }
}

/// The validation features that are switched on, in the form that every generation of the layer knows.
pub(crate) const FEATURES: [vk::ValidationFeatureEnableEXT; 1] =
    [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];

/// A setting of the current layer: its name and its value.
pub(crate) type Setting = (&'static CStr, &'static vk::Bool32);

/// Settings of the current layer. Without them it ignores what draws read, repeated contents of attachments, and every
/// message after an id's tenth.
pub(crate) const SETTINGS: [Setting; 5] = [
    (c"validate_sync", &vk::TRUE),
    (c"syncval_full_validation", &vk::TRUE),
    (c"syncval_shader_accesses_heuristic", &vk::TRUE),
    (c"syncval_load_op_after_store_op_validation", &vk::TRUE),
    (c"enable_message_limit", &vk::FALSE),
];

/// Those of [`SETTINGS`] that the layer knows, by what it said of an instance that was created with all of them. It has no
/// other way to be asked: the loader shows nothing of a layer's settings, and a manifest need not list them.
pub(crate) fn known_settings(said: &[Message]) -> Vec<Setting> {
    let is_known = |(name, _): &Setting| !said.iter().any(|message| message.says_unknown(name));
    SETTINGS.into_iter().filter(is_known).collect()
}

/// Settings as Vulkan takes them.
pub(crate) fn layer_settings(settings: &[Setting]) -> Vec<vk::LayerSettingEXT<'static>> {
    let setting = |(name, value): &Setting| vk::LayerSettingEXT {
        p_layer_name: LAYER.as_ptr(),
        p_setting_name: name.as_ptr(),
        ty: vk::LayerSettingTypeEXT::BOOL32,
        value_count: 1,
        p_values: std::ptr::from_ref::<vk::Bool32>(value).cast(),
        ..Default::default()
    };
    settings.iter().map(setting).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the layers word what follows a fill.
    fn after_a_fill(stage: &str) -> Message {
        let text = format!(
            "vkCmdDispatch: Hazard READ_AFTER_WRITE for VkBuffer 0x28[bins], binding #1 index 0. Access info (usage: \
             SYNC_COMPUTE_SHADER_SHADER_STORAGE_READ, prior_usage: {stage}, write_barriers: 0, command: vkCmdFillBuffer)."
        );
        let id = "SYNC-HAZARD-READ-AFTER-WRITE".to_owned();
        Message { severity: Severity::Error, kind: MessageKind::Validation, id, text, at: None }
    }

    #[test]
    fn a_fill_that_an_old_layer_takes_for_a_copy_is_no_finding() {
        assert!(!after_a_fill("SYNC_COPY_TRANSFER_WRITE").is_finding());
        assert!(after_a_fill("SYNC_CLEAR_TRANSFER_WRITE").is_finding());
        let copied = after_a_fill("SYNC_COPY_TRANSFER_WRITE");
        let copied = Message { text: copied.text.replace("vkCmdFillBuffer", "vkCmdCopyBuffer2"), ..copied };
        assert!(copied.is_finding());
    }

    #[test]
    fn what_is_said_of_each_draw_is_one_mistake() {
        let said =
            |text: &str, at: &str| Message { at: Some(at.to_owned()), text: text.to_owned(), ..after_a_fill("x") };
        let messages = Messages::default();
        for (text, at) in [
            ("of VkImage 0xab12[c], layer 0", "step 0"),
            ("of VkImage 0x9[c], layer 0", "step 0"),
            ("of VkImage 0x9[c], layer 1", "step 0"),
            ("of VkImage 0x9[c], layer 0", "step 1"),
            ("of VkImage 0x77[c], layer 0", "step 0"),
        ] {
            messages.lock().messages.push(said(text, at));
        }
        let counts: Vec<usize> = messages.distinct().into_iter().map(|(_, count)| count).collect();
        assert_eq!(counts, [3, 1, 1]);
    }

    fn unknown_setting(text: &str) -> Message {
        let (id, text) = ("VALIDATION-SETTINGS".to_owned(), text.to_owned());
        Message { severity: Severity::Warning, kind: MessageKind::Validation, id, text, at: None }
    }

    #[test]
    fn the_layer_is_asked_which_settings_it_knows() {
        // As 1.4.309 and later versions word it.
        let said = [
            unknown_setting(
                "vkCreateInstance(): The setting \"syncval_full_validation\" in VkLayerSettingsCreateInfoEXT was not \
                 recognize by the Validation Layers. Please view the VkLayer_khronos_validation.json for a list of all \
                 settings.",
            ),
            unknown_setting("The setting \"validate_sync_more\" in VkLayerSettingsCreateInfoEXT was not recognized."),
            unknown_setting("The setting enable_message_limit was set to type VK_LAYER_SETTING_TYPE_UINT32_EXT."),
        ];
        let known = known_settings(&said);
        let dropped: Vec<_> =
            SETTINGS.iter().map(|it| it.0).filter(|name| known.iter().all(|it| it.0 != *name)).collect();
        assert_eq!(dropped, [c"syncval_full_validation"]);
        assert_eq!(known_settings(&[]).len(), SETTINGS.len());
    }

    #[test]
    fn what_others_look_up_is_no_finding() {
        // As 1.4.300 says it with NVIDIA's driver 580.
        let text = "vkGetDeviceProcAddr(): pName is trying to grab vkGetPhysicalDeviceVideoEncodeQualityLevelPropertiesKHR which \
                    is an instance level function";
        let (id, text) = ("WARNING-vkGetDeviceProcAddr-device".to_owned(), text.to_owned());
        let looked_up = Message { severity: Severity::Warning, kind: MessageKind::Validation, id, text, at: None };
        assert!(!looked_up.is_finding());
        assert!(Message { id: "VUID-vkGetDeviceProcAddr-device-parameter".to_owned(), ..looked_up }.is_finding());
    }

    #[test]
    fn a_message_about_settings_is_no_finding() {
        let message = unknown_setting("The setting \"mine\" in VkLayerSettingsCreateInfoEXT was not recognize.");
        assert!(!message.is_finding());
        let id = "VUID-vkCmdDraw-None-02699".to_owned();
        assert!(Message { id, ..message }.is_finding());
    }
}
