// What the file of a picture says about itself, for people and for programs.
#pragma once
#include <string>

#include "api/picture_info.h"

namespace montelux::cli {

void print_picture_info(const std::string& file, const PictureInfo& info);
void print_picture_info_json(const std::string& file, const PictureInfo& info);

}  // namespace montelux::cli
