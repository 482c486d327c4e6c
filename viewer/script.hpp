// A small list of steps for tests and for the pictures in the documentation: one step per line, # begins a
// comment.
//
//   wait SECONDS
//   wait-for WHAT VALUE SECONDS    until a displayed quantity reaches VALUE, or the script fails after
//   SECONDS
//                                  WHAT: points, lines, triangles (at least VALUE), angle (shown, at most
//                                  VALUE degrees), link (1: attached, 0: not), blank (1: AngDif blank, 0: a
//                                  number), job (1: longer work goes on, 0: none)
//   do ACTION                      one of the operator's actions by its name (F1 and docs/operators-guide.md)
//   view NAME                      front back left right top bottom endoscope
//   camepos AZ EL ROLL DIST        degrees and mm
//   size WIDTH HEIGHT              of the window
//   screenshot FILE                into the folder of --pictures
//   load PATH                      a saved session or a mesh file
//   save FOLDER                    the session; the next step waits until load or save is done, or failed
#pragma once

#include <string>
#include <vector>

#include "common/result.hpp"

namespace linescope {

struct Step {
  int line = 0;  ///< in the file, from 1
  std::string verb;
  std::vector<std::string> words;

  /// words[i] as a number; checked when read.
  double number(std::size_t i) const { return std::stod(words[i]); }
};

/// All steps, or the first fault with its line.
Result<std::vector<Step>> parse_script(const std::string& text, const std::string& origin);
Result<std::vector<Step>> load_script(const std::string& file);

}  // namespace linescope
