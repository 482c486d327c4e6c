// Keeps the surface patch of every cube that is the middle of its column up to date with the cubes' moments.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "viewer/surface/chunked_pool.hpp"
#include "viewer/surface/column_runs.hpp"
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

  /// Fits again what depends on the cubes that changed. A patch is a function of the moments within a few
  /// cubes, so the result does not depend on when this is called.
  void update(const MomentGrid& grid, PatchListener& listener);

  /// True when a cube or one of the 26 around it holds a patch: its points are part of a surface.
  bool carries_surface(const MomentGrid& grid, std::int32_t cell) const;

  void clear();
  std::size_t memory_bytes() const {
    return runs_.memory_bytes() + records_.size() * sizeof(Record) + patches_.size() * sizeof(SurfacePatch);
  }

 private:
  static constexpr std::int32_t kNone = SparseIndex::kNone;
  struct Record {
    std::array<std::int32_t, 3> patch{kNone, kNone, kNone};  ///< per axis: number in patches_
    std::uint8_t middle =
        0;  ///< bit a: the cube was the middle of its column along axis a when last looked at
    std::uint8_t border =
        0;  ///< bit a: it was, and could carry a patch, and some of the columns around were thin
    std::uint8_t redo = 0;  ///< bit a: the patch along axis a has to be looked at
    std::uint8_t wait = 0;  ///< bit a: the same, after all that are not at a border
  };

  /// A patch being fitted.
  struct Candidate {
    std::int32_t cell = 0;
    PatchInput input;
    std::array<ColumnRun, 9> clipped;  ///< columns that reach farther than the patch looks
    PatchFit fit;
  };

  bool collect_affected(const MomentGrid& grid);
  void collect_along(const MomentGrid& grid, std::int32_t from, int axis, int direction);
  void let_borrowers_wait(const MomentGrid& grid);
  void visit(std::int32_t cell, unsigned axes);
  void drop(const MomentGrid& grid, std::int32_t cell, int axis, PatchListener& listener);
  void refit(const MomentGrid& grid, std::int32_t cell, int axis, PatchListener& listener);
  void refit_at_border(const MomentGrid& grid, std::int32_t cell, int axis, PatchListener& listener);
  void hold(const MomentGrid& grid, std::int32_t cell, const std::optional<SurfacePatch>& patch,
            PatchListener& listener);
  void let_wait(std::int32_t cell, unsigned axes);
  CurvaturePrior lent_curvature(const MomentGrid& grid, std::int32_t cell, int axis) const;
  PatchFit& look_at(const MomentGrid& grid, std::int32_t cell, int axis);
  void take(const MomentGrid& grid, PatchListener& listener);
  void solve_taken(const MomentGrid& grid, PatchListener& listener);
  bool is_middle_of_column(const MomentGrid& grid, std::int32_t cell, int axis);
  PatchColumn column_of(const MomentGrid& grid, std::int32_t middle, int axis, int i, ColumnRun& own);
  PatchColumn clipped_column(const MomentGrid& grid, std::int32_t seed, int height, int axis, ColumnRun& own);
  std::int32_t free_patch();

  PatchOptions options_;
  double curvature_variance_;  // expected of d and f, intervals^-2
  ColumnRuns runs_;
  std::array<Candidate, kPatchLanes> candidates_;
  std::size_t taken_ = 0;        // the first of candidates_, which wait to be solved together
  ChunkedPool<Record> records_;  // by number of cube
  ChunkedPool<SurfacePatch> patches_;
  std::vector<std::int32_t> unused_patches_;
  std::vector<std::int32_t> affected_;
  std::vector<std::int32_t> waiting_;
};

}  // namespace linescope
