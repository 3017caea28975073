// Reads tables of measured materials: *.bsdf of the RGL material database (Dupuy and Jakob 2018), with spectra or as
// RGB.
#pragma once
#include <filesystem>
#include <string_view>

#include "material/measured_table.h"
#include "math/result.h"

namespace montelux {

// The content of a file. The error states what is wrong, without the name of the file. Spectra become the linear sRGB
// of a surface under D65 (see reflectance_weights); negative values, which are noise of the measurement, become zero.
Result<MeasuredData> read_measured_data(std::string_view bytes);
// The file's table; the error names the file.
Result<MeasuredTable> read_measured_table(const std::filesystem::path& file);

}  // namespace montelux
