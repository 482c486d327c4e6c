// What must hold for a LIBERTY's byte stream whatever the bytes are. Shared by the fuzzer and the replay of
// its corpus.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace linescope::testing {

/// First byte: bit 0 text or binary, bit 1 with answers, bits 2..7 size of the chunks; the rest is the
/// stream. The promises: every byte is accounted for, so no record of a wrong length was taken; every pose is
/// finite and a rotation; times of a station rise; two whole records behind the end of the input are enough
/// to be in rhythm again. The first broken promise in words; nothing when all hold.
std::optional<std::string> broken_promise(std::span<const std::uint8_t> input);

}  // namespace linescope::testing
