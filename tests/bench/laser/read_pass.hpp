// What no program that looks at a whole picture can beat.
#pragma once

namespace linescope::bench {

/// Reads every byte once, as fast as plain code can.
unsigned long long read_pass(const void* bytes, unsigned long size);

}  // namespace linescope::bench
