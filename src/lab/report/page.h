// The page that shows reports, built from web/ and compiled into the program.
#pragma once
#include <string_view>

namespace montelux::lab {

// The HTML with `page_data_mark` where the JSON belongs; empty where it was not built, and then `why` states the
// reason.
struct Page {
  std::string_view html, why;
};
Page page();

inline constexpr std::string_view page_data_mark = "@@REPORT-DATA@@";

}  // namespace montelux::lab
