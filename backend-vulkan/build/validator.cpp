// The one function of the validator that is seen from outside. It is compiled in one unit with the validator's sources.

#include <cstdint>
#include <cstring>

#include "source/table.h"
#include "spirv-tools/libspirv.h"

// Validates a module of `count` words for Vulkan 1.3. Returns SPIRV-Tools' result: 0 for a valid module.
//
// Blocks may be laid out by the rules of std430 in uniform blocks (`standard`), and by those of scalar layout (`scalar`).
// `instruction`: the number of the instruction that is wrong, from 1; 0 if none is at fault.
// `message`: `capacity` bytes for the first error's words, which end with a zero.
extern "C" __attribute__((visibility("default"))) int framewright_validate_spirv(
    const uint32_t* words, size_t count, bool standard, bool scalar, size_t* instruction, char* message,
    size_t capacity) {
  *instruction = 0;
  message[0] = '\0';
  spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_3);
  spv_validator_options options = spvValidatorOptionsCreate();
  spvValidatorOptionsSetUniformBufferStandardLayout(options, standard);
  spvValidatorOptionsSetScalarBlockLayout(options, scalar);
  // The feature maintenance4 is on.
  spvValidatorOptionsSetAllowLocalSizeId(options, true);
  // Names are found by the caller, and only for what is wrong.
  spvValidatorOptionsSetFriendlyNames(options, false);
  bool told = false;
  spvtools::SetContextMessageConsumer(
      context, [&](spv_message_level_t level, const char*, const spv_position_t& position, const char* text) {
        if (told || level > SPV_MSG_ERROR) return;
        told = true;
        *instruction = position.index;
        std::strncpy(message, text, capacity - 1);
        message[capacity - 1] = '\0';
      });
  spv_const_binary_t binary = {words, count};
  const spv_result_t result = spvValidateWithOptions(context, options, &binary, nullptr);
  spvValidatorOptionsDestroy(options);
  spvContextDestroy(context);
  return result;
}
