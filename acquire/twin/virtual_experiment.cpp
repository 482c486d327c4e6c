#include "acquire/twin/virtual_experiment.hpp"

#include <fmt/format.h>

#include "acquire/twin/ideal_calibration.hpp"

namespace linescope::twin {

Result<std::shared_ptr<const VirtualExperiment>> VirtualExperiment::create(const TwinOptions& options) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  auto phantom = make_phantom(options.phantom);
  if (!phantom) return tl::unexpected(phantom.error());
  auto sheet = make_sheet(options.instrument, options.optics.prism);
  if (!sheet) return tl::unexpected(sheet.error());
  std::shared_ptr<VirtualExperiment> made(new VirtualExperiment(options, *phantom, std::move(*sheet)));
  if (made->truth_.spots().size() != static_cast<std::size_t>(options.hand.spots)) {
    return fail(
        ErrorCode::invalid,
        fmt::format("only {} of {} marked spots lie on the phantom: make the site ({:g} x {:g} mm) smaller",
                    made->truth_.spots().size(), options.hand.spots, options.phantom.site_length_mm,
                    options.phantom.site_width_mm));
  }
  return made;
}

VirtualExperiment::VirtualExperiment(const TwinOptions& options, std::shared_ptr<const Phantom> phantom,
                                     std::unique_ptr<LaserSheet> sheet)
    : options_(options),
      truth_(options, std::move(phantom)),
      calibration_(ideal_calibration(options)),
      sheet_(std::move(sheet)) {}

}  // namespace linescope::twin
