// What the tracker's millimetres and its sense of left and right say about the board: a wrong square size and
// mirrored pictures, which pictures alone cannot show. The hand-eye step asks always; camera and laser ask
// when the pictures came with poses.
#pragma once

#include <optional>

#include "tools/calibrate/hand_eye_solve.hpp"
#include "tools/calibrate/step.hpp"

namespace linescope::calibrate {

/// "tracker's mm per board's mm" of a solution that was refined with its scale.
Figure scale_figure(const HandEyeSolution& scaled);

/// A refusal when the scale is off by more than `most` and by more than three standard deviations.
std::optional<Error> wrong_square(const HandEyeSolution& scaled, const BoardOptions& board, double most);

/// A refusal when the chain fits to `mirrored_mm` with all pictures read in a mirror, to `as_is_mm` as they
/// are, and the former is the clearly better one.
std::optional<Error> mirrored_pictures(double as_is_mm, double mirrored_mm);

/// For steps that need no tracker: when eight or more pictures came with poses, turned about two axes, and
/// board and tracker saw the same motion, `outcome` gets the scale as a figure and, if it has none yet, a
/// refusal for a wrong square or mirrored pictures. Otherwise a remark says why nobody was asked; nothing
/// without any pose. The board is taken to rest in the room.
void ask_tracker(Outcome& outcome, const Session& session, const BoardOptions& board,
                 const CameraModel& camera, Nanoseconds latency);

}  // namespace linescope::calibrate
