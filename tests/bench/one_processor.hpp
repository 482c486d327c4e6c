// One processor for a whole benchmark: the alternatives share its caches, and libraries that would use more
// threads gain nothing by it.
#pragma once

#include <sched.h>

namespace linescope::bench {

/// Keeps this thread, and all that it starts from here on, on the processor it runs on now. Before the first
/// call into a library that starts threads.
inline void pin_to_this_processor() {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(sched_getcpu(), &set);
  sched_setaffinity(0, sizeof(set), &set);
}

}  // namespace linescope::bench
