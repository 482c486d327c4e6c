// Memory for pictures on the processor's large pages.
//
// A 640x480 picture covers 225 pages of 4 KiB, and a processor that reads it from memory waits for the
// address of each; on one page of 2 MiB it does not. The line extraction takes a tenth less then
// (docs/performance-laser.md).
#pragma once

#include <opencv2/core/mat.hpp>

namespace linescope {

/// For cv::Mat::allocator, set before the picture gets its memory: each picture then begins on a large page
/// of its own, and what is smaller than a quarter of one comes from OpenCV's usual memory. Where the system
/// gives no large pages (/sys/kernel/mm/transparent_hugepage/enabled is "never") the memory is ordinary,
/// nothing else changes. cv::Exception (StsNoMem) when there is no memory. Any thread; lives as long as the
/// program.
cv::MatAllocator& large_pages();

}  // namespace linescope
