// Filters that remove noise, by name.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "denoise/color_filter.h"
#include "math/result.h"
#include "parameter/spec.h"

namespace montelux {

std::span<const EntitySpec> denoiser_table();
// Each with a one-line description.
std::vector<std::pair<std::string, std::string>> denoiser_names();

// Fails if this names no filter, or has wrong settings. Nothing is loaded.
Status check_denoiser(std::string_view text);

// "montelux", or "oidn" with a setting, "oidn:library=FILE". Null for montelux, our own. Fails if there is no such
// filter, or if it is not installed.
Result<std::shared_ptr<const ColorFilter>> parse_denoiser(std::string_view text);

}  // namespace montelux
