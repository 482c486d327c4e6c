// Keeps the surface patch of every cube that is the middle of its column up to date with the cubes' moments.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "viewer/surface/chunked_pool.hpp"
#include "viewer/surface/moment_grid.hpp"
#include "viewer/surface/surface_patch.hpp"

namespace linescope {

/// Takes note of patches as they come and go.
class PatchListener {
 public:
  virtual ~PatchListener() = default;
  virtual void patch_added(const MomentCell& cell, const SurfacePatch& patch) = 0;
  virtual void patch_removed(const MomentCell& cell, const SurfacePatch& patch) = 0;
};

class PatchMap {
 public:
  explicit PatchMap(const MesherOptions& options);

  /// Fits again what depends on the cubes that changed. A patch is a function of the moments within four
  /// cubes, so the result does not depend on when this is called.
  void update(const MomentGrid& grid, PatchListener& listener);

  /// True when a cube or one of the 26 around it holds a patch: its points are part of a surface.
  bool carries_surface(const MomentGrid& grid, std::int32_t cell) const;

  void clear() { records_.clear(); }
  std::size_t memory_bytes() const { return records_.size() * sizeof(Record); }

 private:
  struct Record {
    CellStatistics statistics;
    std::uint8_t axes = 0;    ///< bit a: the normal around the cube points well along axis a
    std::uint32_t round = 0;  ///< the update that last visited it
    std::array<std::optional<SurfacePatch>, 3> patches;
  };

  void collect_affected(const MomentGrid& grid);
  void visit(std::int32_t cell);
  void find_axes(const MomentGrid& grid, std::int32_t cell);
  void refit(const MomentGrid& grid, std::int32_t cell, PatchListener& listener);
  std::optional<SurfacePatch> fit(const MomentGrid& grid, const MomentCell& cell, int axis);
  bool is_middle_of_column(const MomentGrid& grid, const MomentCell& cell, int axis) const;
  void gather_column(const MomentGrid& grid, const MomentCell& cell, int axis, int u, int v,
                     PatchColumn& column) const;

  PatchOptions options_;
  ChunkedPool<Record> records_;  // by number of cube
  std::vector<std::int32_t> affected_;
  std::uint32_t round_ = 0;
};

}  // namespace linescope
