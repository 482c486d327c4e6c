#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {

const char* const kWords =
    "Words as in ASTM F2554. Bias: mean signed deviation from the truth. Precision: standard deviation "
    "within "
    "one scan. Repeatability: standard deviation of the result between sweeps over the same place with the "
    "same "
    "set-up. Reproducibility: the same between seeds, that is another room, another hand. Figures are mean "
    "+- 95 % "
    "interval of the mean over the seeds. A thesis figure marked = lies within the 95 % prediction interval "
    "of "
    "one of our experiments with the thesis's algorithms; one marked ! does not.";

void add_note(Table& table, std::string_view sentence) {
  table.notes.emplace_back(sentence);
}

Agreement agreement(const Row& row) {
  if (!row.thesis || !row.plain || row.plain->count < 3) return Agreement::not_comparable;
  return could_be(*row.plain, *row.thesis) ? Agreement::could_be : Agreement::differs;
}

}  // namespace linescope::evaluate
