// Is a PLY file as long as its header says? VTK's reader trusts the header and crashes on a file that was cut
// off.
#pragma once

#include <string>

namespace linescope {

/// What is wrong with the file's contents, or nothing.
std::string ply_fault(const std::string& contents);

}  // namespace linescope
