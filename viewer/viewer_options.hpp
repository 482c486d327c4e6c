// The command line of linescope-viewer.
#pragma once

#include <string>
#include <variant>

#include "common/exit_code.hpp"
#include "viewer/navigation_worker.hpp"
#include "viewer/segment_feed.hpp"
#include "viewer/surface/mesher_options.hpp"

namespace linescope {

struct ViewerOptions {
  FeedOptions feed;
  MesherOptions mesher{.method = MeshMethod::proposed_cubes};
  NormalChoice normal = NormalChoice::robust;
  int width = 1280, height = 720;
  double font_scale = 1;
  double quit_after_s = 0;     ///< 0: never
  std::string screenshot;      ///< file, written before the end; empty: none
  std::string script;          ///< file with steps; empty: none
  std::string pictures = ".";  ///< folder for the pictures of a script
  std::string state_json;      ///< file kept up to date with what is displayed; empty: none
};

/// First fault in one sentence.
Result<void> validate(const ViewerOptions& options);

/// What was printed instead of running (help, version).
struct Printed {
  std::string text;
};

/// The options; or what to print; or one sentence that says what is wrong.
tl::expected<std::variant<ViewerOptions, Printed>, Refusal> read_viewer_options(int argc,
                                                                                const char* const* argv);

}  // namespace linescope
