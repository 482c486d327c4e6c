// What a mutated segment does to a reader, and a mutated mailbox to the daemon: the body of the fuzz targets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace linescope::testing {

/// The input is a list of patches to a good segment: offset (4 bytes, modulo the size), length (1 byte),
/// bytes; an offset of 0xfffffff0 and above cuts the object short or makes it longer. The segment is then
/// attached to and everything is read.
void read_mutated_segment(std::span<const std::uint8_t> input);

/// The same for the control segment, under a living server.
void poll_mutated_mailbox(std::span<const std::uint8_t> input);

}  // namespace linescope::testing
