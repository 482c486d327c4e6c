// A flat calibration board: a printed chessboard on a white plate that goes on for ever.
//
// The pattern's middle is the phantom's origin. Seen from the endoscope in its usual attitude the long side
// lies along the picture's rows and the square in the upper left corner is black.
#pragma once

#include "acquire/twin/paint.hpp"
#include "acquire/twin/phantom_kind.hpp"
#include "acquire/twin/simple_shapes.hpp"
#include "common/rigid_transform.hpp"

namespace linescope::twin {

/// Frame `Board` in the phantom's: origin at the first inner corner (beside the black corner square), x along
/// the long side, y along the other one, z into the board.
Rigid<PhantomFrame, Board> phantom_from_board(const BoardPattern& pattern);

class BoardPhantom : public PlaneBody, public Paint {
 public:
  explicit BoardPhantom(const BoardPattern& pattern);

  const Paint* paint() const override { return this; }
  double reflectance(const Eigen::Vector3d& place, const Eigen::Vector3d& right,
                     const Eigen::Vector3d& down) const override;
  std::string json() const override;

 private:
  BoardPattern pattern_;
  Rigid<Board, PhantomFrame> board_from_phantom_;
};

}  // namespace linescope::twin
