// Lines of points in, triangles out: the seam between the viewer and the ways of making a surface.
//
// A mesher belongs to one thread (the viewer's numeric thread). Nothing here throws; impossible points are
// refused and counted by reason. The mesh depends on the lines that were added, not on when it was asked for:
// asking after every line and asking once at the end give the same arrays, bit for bit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/result.hpp"
#include "viewer/surface/hole_filler.hpp"
#include "viewer/surface/mesher_options.hpp"
#include "viewer/surface/surface_line.hpp"
#include "viewer/surface/triangle_mesh.hpp"

namespace linescope {

/// Everything that came in and what became of it. Only ever grows, until clear().
struct MesherCounters {
  std::uint64_t lines = 0;          ///< lines taken (with at least one usable point)
  std::uint64_t points = 0;         ///< points used
  std::uint64_t lines_refused = 0;  ///< nothing usable in them, or `seen_from` not a number or out of reach
  std::uint64_t not_finite = 0;     ///< points refused: NaN or infinite coordinate or deviation
  std::uint64_t too_far = 0;        ///< points refused: beyond MesherOptions::max_distance
  std::uint64_t too_uncertain =
      0;                      ///< points refused: negative deviation or above MesherOptions::max_deviation
  std::uint64_t no_room = 0;  ///< points refused: MesherOptions::max_memory reached, or outside the numbered
                              ///< grid (4 million intervals)
  std::uint64_t points_removed = 0;  ///< points taken out again by remove_last_sweep()

  std::uint64_t refused() const { return not_finite + too_far + too_uncertain + no_room; }
};

/// State, not history: what the surface is made of at the moment.
struct MesherState {
  std::size_t occupied_cells = 0;  ///< cubes that hold points (implicit), marked grid vertices (PMC, CMC)
  std::size_t set_aside =
      0;  ///< of them: too few points or lines around to carry surface, or contradicting neighbours
  std::size_t sweeps = 0;        ///< sweeps that remove_last_sweep() could take back, one by one
  std::size_t memory_bytes = 0;  ///< held by the mesher, without the mesh itself
};

class Mesher {
 public:
  virtual ~Mesher() = default;

  /// What follows is a new sweep: the unit of remove_last_sweep(). A pause longer than `sweep_pause` does the
  /// same.
  virtual void begin_sweep() = 0;

  /// Takes one line in. Cost: by its points and the cells they touch, not by what is there already.
  virtual void add_line(const SurfaceLine& line) = 0;

  /// As if the last sweep had never been. False when there is none left.
  virtual bool remove_last_sweep() = 0;

  /// As new, counters too. Memory is kept for the next scan.
  virtual void clear() = 0;

  /// Brings the surface up to date with the lines; cost by what changed. write_mesh() does it too.
  virtual void update() = 0;

  /// Copies the mesh out (reusing the arrays' memory); cost by the size of the surface.
  virtual void write_mesh(TriangleMesh& mesh) = 0;

  /// The grid behind the mesh for display (thesis Figs 4.8e, 4.13b), mm: the marked vertices (PMC, CMC), or
  /// the grid vertices nearest to the surface (implicit).
  virtual std::vector<Eigen::Vector3f> grid_vertices() = 0;

  virtual MesherCounters counters() const = 0;
  virtual MesherState state() = 0;

  /// What became of the holes in the mesh written last; nothing where none are to be filled.
  virtual std::optional<HoleCounts> holes() const { return std::nullopt; }

  virtual const MesherOptions& options() const = 0;

  TriangleMesh mesh() {
    TriangleMesh result;
    write_mesh(result);
    return result;
  }
};

/// A mesher for the options, or what is wrong with them.
Result<std::unique_ptr<Mesher>> make_mesher(const MesherOptions& options);

}  // namespace linescope
