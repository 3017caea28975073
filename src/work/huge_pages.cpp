#include "work/huge_pages.h"

#if defined(__linux__)
#include <sys/mman.h>

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#endif

namespace montelux {

void use_huge_pages() {
#if defined(__linux__)
  // "always madvise [never]": collapsing would override the last one.
  std::string mode;
  std::getline(std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"), mode);
  if (mode.empty() || mode.find("[never]") != std::string::npos) return;
#if defined(MADV_COLLAPSE)
  constexpr int collapse = MADV_COLLAPSE;
#else
  constexpr int collapse = 25;  // Linux 6.1; the C library may be older
#endif
  constexpr std::uintptr_t page = std::uintptr_t(1) << 21;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    // "begin-end permissions offset device inode path": memory of no file has inode 0 and no path, or is the heap.
    std::uintptr_t begin = 0, end = 0;
    char permissions[5] = {}, path[64] = {};
    unsigned long inode = 0;
    if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %4s %*s %*s %lu %63s", &begin, &end, permissions, &inode,
                    path) < 4)
      continue;
    const bool is_memory = std::string_view(permissions) == "rw-p" && inode == 0 &&
                           (path[0] == '\0' || std::string_view(path) == "[heap]");
    begin = (begin + page - 1) / page * page, end = end / page * page;
    if (!is_memory || begin >= end) continue;
    void* const first = reinterpret_cast<void*>(begin);
    madvise(first, end - begin, collapse);  // fails for the parts that are not filled, such as the rest of a stack
  }
#endif
}

}  // namespace montelux
