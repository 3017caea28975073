// The picture that the methods of a comparison are held against: where it comes from, and keeping it for later. Inside
// the facade only.
#pragma once
#include "api/comparison.h"
#include "api/parts.h"

namespace montelux {

// A picture that the user named, or the methods that may make one.
struct ReferenceSource {
  std::optional<lab::Reference> reference;
  std::vector<std::size_t> may_serve;
};

// Fails where the named picture cannot be read, has another size or holds values that are not finite, and where no
// method may make a reference.
Result<ReferenceSource> find_reference(const ComparisonOptions& options,
                                       const std::vector<lab::ComparedMethod>& compared_methods,
                                       const PixelBounds& bounds);

// The file in the user's cache folder for a reference by this method, or by another of the same biases; nothing where
// there is no such folder. Its name changes with any file beside the scene or below.
std::optional<std::filesystem::path> reference_cache(const LoadedScene::Parts& parts, const PixelBounds& bounds,
                                                     const lab::ComparedMethod& method);
// Nothing where there is none, or its variance by relMSE or by MSE is larger than this.
std::optional<lab::Reference> kept_reference(const std::filesystem::path& file, const PixelBounds& bounds,
                                             const lab::ByMeasure<double>& variance);
void keep_reference(const std::filesystem::path& file, const lab::Reference& reference);

}  // namespace montelux
