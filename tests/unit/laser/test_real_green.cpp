// A green line on a hand-held chessboard and on the table in front of it: bluish room, an object between
// board and table, skirting and hand beside them, in one picture the line's reflection in the table.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/laser/real_pictures.hpp"

namespace linescope {
namespace {

/// Where the line was seen by eye: ends of straight pieces, px, good to about 3 px.
struct Piece {
  double u0, v0, u1, v1;
  double at(double v) const { return u0 + (u1 - u0) * (v - v0) / (v1 - v0); }
  bool covers(double v, double margin) const { return v >= v0 - margin && v <= v1 + margin; }
};

struct Marked {
  const char* file;
  Piece board, table;
  double least_board = 0.95, least_table = 0.80;  ///< parts of the rows
};

/// The table and the laser stand still; where the table's line begins depends on the board.
constexpr Piece table_from(double v) {
  return {782 + (v - 695) * 266 / 384, v, 1048, 1079};
}

class GreenLine : public ::testing::TestWithParam<Marked> {};

TEST_P(GreenLine, IsOnTheBoardAndOnTheTableAndNowhereElse) {
  LINESCOPE_NEEDS_SHARED_DATA();
  constexpr double kNear = 8, kEnds = 8;
  const auto& [file, board, table, least_board, least_table] = GetParam();
  LineExtractor extractor(testing::along_rows(LaserColour::green));
  const std::vector<double> u = testing::middles(extractor, testing::shared_data("green/laser") / file);
  ASSERT_EQ(u.size(), 1080U);
  int on_board = 0, on_table = 0, elsewhere = 0;
  for (int v = 0; v < 1080; ++v) {
    const double found = u[static_cast<std::size_t>(v)];
    if (std::isnan(found)) continue;
    if (board.covers(v, kEnds) && std::abs(found - board.at(v)) < kNear)
      ++on_board;
    else if (table.covers(v, kEnds) && std::abs(found - table.at(v)) < kNear)
      ++on_table;
    else
      ++elsewhere;
  }
  const double board_rows = board.v1 - board.v0, table_rows = table.v1 - table.v0;
  RecordProperty("board", std::to_string(on_board / board_rows));
  RecordProperty("table", std::to_string(on_table / table_rows));
  RecordProperty("elsewhere", elsewhere);
  EXPECT_GE(on_board, least_board * board_rows);
  EXPECT_GE(on_table, least_table * table_rows);
  EXPECT_EQ(elsewhere, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Pictures, GreenLine,
    ::testing::Values(Marked{"Image1.png", {857, 0, 882, 818}, table_from(824)},
                      Marked{"Image3.png", {716, 0, 671, 578}, table_from(695)},
                      Marked{"Image5.png", {713, 0, 686, 678}, table_from(695)},
                      Marked{"Image7.png", {806, 0, 864, 613}, table_from(695)},
                      Marked{"Image9.png", {791, 0, 993, 971}, table_from(976)},
                      // Out of focus: on the table ten grey levels high, on the board's dark rim hardly more.
                      Marked{"Image11.png", {888, 0, 761, 527}, table_from(695), 0.90, 0.30}),
    [](const auto& i) { return std::string(i.param.file, std::string(i.param.file).find('.')); });

}  // namespace
}  // namespace linescope
