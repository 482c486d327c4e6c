// Taking the name of a segment at start: who lives is left alone, who is dead is replaced.
#pragma once

#include "common/result.hpp"
#include "ipc/segment_options.hpp"
#include "ipc/shared_object.hpp"

namespace linescope {

/// A new, empty object under options.name with all pages reserved. Errors: see SegmentWriter::create.
/// Leftovers of a dead writer are marked as replaced by `session_id` and removed.
Result<SharedObject> claim_segment(const SegmentOptions& options, std::size_t bytes,
                                   std::uint64_t session_id);

}  // namespace linescope
