#include "tools/mesh/mesh_reader.hpp"

#include <vtkAlgorithm.h>
#include <vtkAlgorithmOutput.h>
#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkCommand.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkOutputWindow.h>
#include <vtkPLYReader.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cctype>

namespace linescope {
namespace {

template <class Reader>
vtkSmartPointer<vtkAlgorithm> reader_of(const std::string& file) {
  auto reader = vtkSmartPointer<Reader>::New();
  reader->SetFileName(file.c_str());
  return reader;
}

vtkSmartPointer<vtkAlgorithm> reader_for(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".stl") return reader_of<vtkSTLReader>(file.string());
  if (suffix == ".ply") return reader_of<vtkPLYReader>(file.string());
  if (suffix == ".obj") return reader_of<vtkOBJReader>(file.string());
  if (suffix == ".vtp") {
    auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
    reader->SetFileName(file.c_str());
    return reader;
  }
  return nullptr;
}

/// Hears what VTK would otherwise print over several lines.
class FirstComplaint : public vtkCommand {
 public:
  static FirstComplaint* New() { return new FirstComplaint; }
  void Execute(vtkObject*, unsigned long, void*) override { heard = true; }
  bool heard = false;
};

void copy(vtkPolyData& data, MeshArrays& mesh) {
  mesh.points.resize(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.points.size(); ++i)
    data.GetPoint(static_cast<vtkIdType>(i), mesh.points[i].data());
  vtkNew<vtkIdList> corners;
  vtkCellArray* cells = data.GetPolys();
  for (cells->InitTraversal(); cells->GetNextCell(corners) != 0;) {
    if (corners->GetNumberOfIds() != 3) continue;
    mesh.triangles.push_back({static_cast<int>(corners->GetId(0)), static_cast<int>(corners->GetId(1)),
                              static_cast<int>(corners->GetId(2))});
  }
}

}  // namespace

MeshArrays read_mesh(const std::filesystem::path& file) {
  MeshArrays mesh;
  const auto fault = [&](const std::string& what) {
    mesh.fault = file.string() + ": " + what;
    return mesh;
  };
  if (!std::filesystem::is_regular_file(file)) return fault("no such file");
  const auto reader = reader_for(file);
  if (!reader) return fault("no mesh file that is known here: use .stl, .ply, .obj or .vtp");
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<FirstComplaint> complaint;
  reader->AddObserver(vtkCommand::ErrorEvent, complaint);
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(reader->GetOutputPort());
  triangles->PassVertsOff();
  triangles->PassLinesOff();
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputConnection(triangles->GetOutputPort());
  clean->ConvertPolysToLinesOff();
  clean->Update();
  if (complaint->heard || reader->GetErrorCode() != 0)
    return fault("it cannot be read as what its suffix says; save it again, or under the right suffix");
  copy(*clean->GetOutput(), mesh);
  return mesh;
}

}  // namespace linescope
