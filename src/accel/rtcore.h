// The kernel's own header: Embree 4 if available, else Embree 3. CMake searches in the same order.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
