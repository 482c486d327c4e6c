#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkOBJWriter.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSTLWriter.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnsignedIntArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <fstream>

#include "viewer/scene/mesh_file.hpp"
#include "viewer/scene/mesh_suffix.hpp"

namespace linescope {
namespace {

vtkSmartPointer<vtkFloatArray> vectors(const std::vector<Eigen::Vector3f>& values, const char* name) {
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(3);
  for (const Eigen::Vector3f& v : values) array->InsertNextTuple(v.data());
  return array;
}

template <class Array, class Values>
vtkSmartPointer<Array> numbers(const Values& values, const char* name) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  for (const auto v : values) array->InsertNextValue(static_cast<typename Array::ValueType>(v));
  return array;
}

void add_word(vtkPolyData& data, const char* name, const std::string& word) {
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(word);
  data.GetFieldData()->AddArray(array);
}

vtkSmartPointer<vtkPolyData> poly_data(const TriangleMesh& mesh) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetData(vectors(mesh.positions, "Points"));
  data->SetPoints(points);
  vtkNew<vtkCellArray> cells;
  for (const auto& t : mesh.triangles) cells->InsertNextCell({t[0], t[1], t[2]});
  data->SetPolys(cells);
  if (mesh.normals.size() == mesh.positions.size())
    data->GetPointData()->SetNormals(vectors(mesh.normals, "Normals"));
  return data;
}

void add_the_rest(const TriangleMesh& mesh, const std::string& frame, vtkPolyData& data) {
  if (mesh.uncertainty.size() == mesh.positions.size())
    data.GetPointData()->AddArray(numbers<vtkFloatArray>(mesh.uncertainty, "uncertainty_mm"));
  if (mesh.observations.size() == mesh.positions.size())
    data.GetPointData()->AddArray(numbers<vtkUnsignedIntArray>(mesh.observations, "observations"));
  if (mesh.origin.size() == mesh.triangles.size())
    data.GetCellData()->AddArray(numbers<vtkUnsignedCharArray>(mesh.origin, "origin"));
  add_word(data, "frame", frame);
  add_word(data, "unit", "mm");
}

template <class Writer>
bool written(Writer& writer, vtkPolyData& data, const std::filesystem::path& file) {
  writer.SetFileName(file.c_str());
  writer.SetInputData(&data);
  return writer.Write() == 1 && writer.GetErrorCode() == 0;
}

/// VTK's writers of text have no comments: the line is put in after the first `lines_before` lines.
bool put_in(const std::string& line, int lines_before, const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::size_t at = 0;
  for (int i = 0; i < lines_before; ++i) at = text.find('\n', at) + 1;
  text.insert(at, line + '\n');
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  return static_cast<bool>(out.flush());
}

bool write_as(const std::string& suffix, const TriangleMesh& mesh, const std::string& frame,
              const std::filesystem::path& file) {
  const auto data = poly_data(mesh);
  const std::string words = "linescope: frame " + frame + ", unit mm; research, not for clinical use";
  if (suffix == ".vtp") {
    add_the_rest(mesh, frame, *data);
    return written(*vtkNew<vtkXMLPolyDataWriter>(), *data, file) && put_in("<!-- " + words + " -->", 1, file);
  }
  if (suffix == ".ply") {
    vtkNew<vtkPLYWriter> writer;
    writer->AddComment(words);
    return written(*writer, *data, file);
  }
  if (suffix == ".stl") {
    vtkNew<vtkSTLWriter> writer;
    writer->SetFileTypeToBinary();
    writer->SetHeader(words.substr(0, 79).c_str());
    return written(*writer, *data, file);
  }
  return written(*vtkNew<vtkOBJWriter>(), *data, file) && put_in("# " + words, 0, file);
}

}  // namespace

Result<void> write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file,
                        const std::string& frame) {
  const std::string suffix = mesh_suffix(file);
  if (suffix != ".ply" && suffix != ".vtp" && suffix != ".stl" && suffix != ".obj")
    return fail(
        ErrorCode::unsupported,
        file.string() + ": meshes are written as .ply, .vtp, .stl or .obj; choose one of these suffixes");
  if (mesh.empty()) return fail(ErrorCode::invalid, file.string() + ": there is no surface yet to write");
  vtkObject::GlobalWarningDisplayOff();
  // With the suffix at its end: VTK puts it there if it is not.
  const std::filesystem::path part = std::filesystem::path(file).replace_extension(".part" + suffix);
  std::error_code error;
  const bool good = write_as(suffix, mesh, frame, part);
  if (good) std::filesystem::rename(part, file, error);
  if (good && !error) return {};
  std::filesystem::remove(part, error);
  return fail(
      ErrorCode::permission,
      file.string() + ": the mesh cannot be written; is the folder there, writable, and the disk not full?");
}

}  // namespace linescope
