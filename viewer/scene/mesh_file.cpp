#include "viewer/scene/mesh_file.hpp"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
#include <vtkCommand.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <limits>

#include "viewer/scene/mesh_suffix.hpp"
#include "viewer/scene/ply_check.hpp"

namespace linescope {

std::string mesh_suffix(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

namespace {

template <class Reader>
vtkSmartPointer<vtkAlgorithm> reader_of(const std::string& file) {
  auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(file.c_str());
  return reader;
}

vtkSmartPointer<vtkAlgorithm> reader_for(const std::filesystem::path& file) {
  const std::string suffix = mesh_suffix(file);
  if (suffix == ".stl") return reader_of<vtkSTLReader>(file.string());
  if (suffix == ".ply") return reader_of<vtkPLYReader>(file.string());
  if (suffix == ".obj") return reader_of<vtkOBJReader>(file.string());
  if (suffix == ".vtp") return reader_of<vtkXMLPolyDataReader>(file.string());
  return nullptr;
}

/// Hears what VTK would otherwise print over several lines.
class Complaint : public vtkCommand {
 public:
  static Complaint* New() { return new Complaint; }
  void Execute(vtkObject*, unsigned long, void*) override { heard = true; }
  bool heard = false;
};

/// Triangles with shared corners and normals, or nothing when the reader complained.
vtkSmartPointer<vtkPolyData> read_triangles(vtkAlgorithm& reader, bool corners_repeat) {
  vtkNew<Complaint> complaint;
  reader.AddObserver(vtkCommand::ErrorEvent, complaint);
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(reader.GetOutputPort());
  triangles->PassVertsOff();
  triangles->PassLinesOff();
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputConnection(triangles->GetOutputPort());
  clean->ConvertPolysToLinesOff();
  clean->SetPointMerging(corners_repeat);
  clean->Update();
  if (complaint->heard || reader.GetErrorCode() != 0) return nullptr;
  return clean->GetOutput();
}

vtkSmartPointer<vtkPolyData> with_normals(vtkPolyData& data) {
  if (data.GetPointData()->GetNormals() != nullptr) return &data;
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(&data);
  normals->SplittingOff();
  normals->ConsistencyOff();
  normals->Update();
  return normals->GetOutput();
}

std::string contents_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

Eigen::Vector3f vector(const double* v) {
  return Eigen::Vector3d(v[0], v[1], v[2]).cast<float>();
}

void copy_vertices(vtkPolyData& data, TriangleMesh& mesh) {
  const vtkIdType count = data.GetNumberOfPoints();
  vtkDataArray* normals = data.GetPointData()->GetNormals();
  vtkDataArray* uncertainty = data.GetPointData()->GetArray("uncertainty_mm");
  vtkDataArray* observations = data.GetPointData()->GetArray("observations");
  for (vtkIdType i = 0; i < count; ++i) {
    mesh.positions.push_back(vector(data.GetPoint(i)));
    mesh.normals.push_back(normals ? vector(normals->GetTuple3(i)) : Eigen::Vector3f(0, 0, 1));
    mesh.uncertainty.push_back(uncertainty ? static_cast<float>(uncertainty->GetTuple1(i))
                                           : std::numeric_limits<float>::quiet_NaN());
    mesh.observations.push_back(observations ? static_cast<std::uint32_t>(observations->GetTuple1(i)) : 0);
  }
}

void copy_triangles(vtkPolyData& data, TriangleMesh& mesh) {
  vtkDataArray* origin = data.GetCellData()->GetArray("origin");
  vtkNew<vtkIdList> corners;
  vtkCellArray& cells = *data.GetPolys();
  for (vtkIdType i = 0; i < cells.GetNumberOfCells(); ++i) {
    cells.GetCellAtId(i, corners);
    if (corners->GetNumberOfIds() != 3) continue;
    const auto corner = [&](vtkIdType k) { return static_cast<std::uint32_t>(corners->GetId(k)); };
    mesh.triangles.push_back({corner(0), corner(1), corner(2)});
    mesh.origin.push_back(origin && origin->GetTuple1(i) != 0 ? TriangleOrigin::filled
                                                              : TriangleOrigin::measured);
  }
}

}  // namespace

Result<TriangleMesh> read_mesh(const std::filesystem::path& file, Corners corners) {
  const auto refused = [&](ErrorCode code, const char* what) {
    return fail(code, file.string() + ": " + what);
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return refused(ErrorCode::not_found, "no such file");
  const auto reader = reader_for(file);
  if (!reader)
    return refused(ErrorCode::unsupported, "no mesh file that is known here: use .ply, .vtp, .stl or .obj");
  if (mesh_suffix(file) == ".ply")
    if (const std::string why = ply_fault(contents_of(file)); !why.empty())
      return refused(ErrorCode::unreadable, (why + "; save it again").c_str());
  vtkObject::GlobalWarningDisplayOff();
  const auto data = read_triangles(*reader, corners == Corners::merged || mesh_suffix(file) == ".stl");
  if (!data)
    return refused(ErrorCode::unreadable,
                   "it cannot be read as what its suffix says; save it again, or under the right suffix");
  const auto shaded = with_normals(*data);
  TriangleMesh mesh;
  copy_vertices(*shaded, mesh);
  copy_triangles(*shaded, mesh);
  if (mesh.empty())
    return refused(ErrorCode::unreadable, "it is empty, there is no triangle in it; is the file complete?");
  for (const Eigen::Vector3f& p : mesh.positions)
    if (!p.allFinite()) return refused(ErrorCode::invalid, "a coordinate is not a finite number");
  return mesh;
}

}  // namespace linescope
