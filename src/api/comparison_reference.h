// The reference image of a comparison: its origin, and storing it in the cache. Internal to
// the facade.
#pragma once
#include "api/comparison.h"
#include "api/parts.h"

namespace montelux {

// An image stated by the user, or the methods that may render one.
struct ReferenceSource {
  std::optional<lab::Reference> reference;
  std::vector<std::size_t> may_serve;
};

// Fails if the stated image cannot be read, has another size or contains values that are not finite, and if no
// method may render a reference.
Result<ReferenceSource> find_reference(const ComparisonOptions& options,
                                       const std::vector<lab::ComparedMethod>& compared_methods,
                                       const PixelBounds& bounds);

// The file in the user's cache folder for a reference by this method, or by another one with the same biases; nothing
// if there is no such folder. Its name changes with any file in the scene's folder or below.
std::optional<std::filesystem::path> reference_cache(const LoadedScene::Parts& parts, const PixelBounds& bounds,
                                                     const lab::ComparedMethod& method);
// Nothing if there is none, or if its variance by relMSE or by MSE exceeds these limits.
std::optional<lab::Reference> kept_reference(const std::filesystem::path& file, const PixelBounds& bounds,
                                             const lab::ByMeasure<double>& variance);
void keep_reference(const std::filesystem::path& file, const lab::Reference& reference);

}  // namespace montelux
