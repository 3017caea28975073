#include "integrator/path_classes.h"

namespace montelux {

namespace {

constexpr std::size_t class_count = path_class_names.size();
using enum Finding;

// In the order of PathClass. Paths from the eye end at a lamp, or by a light sample at a rough surface: light of a
// delta light whose first event is at a smooth surface is found in neither way.
constexpr std::array<Finding, class_count> any_length_row{yes, yes, yes, yes, yes, yes, by_chance, by_chance, no, no};
constexpr std::array<Finding, class_count> with_chains_row{yes, yes,       yes,       yes,          yes,
                                                           yes, by_chance, by_chance, short_chains, short_chains};
constexpr std::array<Finding, class_count> one_event_row{yes, yes, yes, no, no, no, no, no, no, no};
constexpr std::array<Finding, class_count> diffuse_row{yes, yes,     refused, refused, refused,
                                                       yes, refused, refused, refused, refused};

// Paths from the lights are connected with the lens at rough vertices alone.
constexpr std::array<Finding, class_count> from_lights_row{yes, yes, no, no, no, yes, yes, no, yes, no};

// Paths from both ends find what either of them finds. A path of the form LS..SDS..SE has no two rough vertices to
// connect, and comes to a lamp by chance alone.
constexpr std::array<Finding, class_count> both_ends_row{yes, yes, yes, yes, yes, yes, yes, by_chance, yes, no};

// Photons end at rough surfaces, to which paths from the eye go by smooth ones.
constexpr std::array<Finding, class_count> photons_row{yes, yes, yes, yes, yes, yes, yes, yes, yes, yes};

}  // namespace

std::optional<Finding> finding(LightSearch search, PathClass path_class) {
  const auto column = std::size_t(path_class);
  switch (search) {
    case LightSearch::any_length:
      return any_length_row[column];
    case LightSearch::with_chains:
      return with_chains_row[column];
    case LightSearch::one_event:
      return one_event_row[column];
    case LightSearch::diffuse:
      return diffuse_row[column];
    case LightSearch::from_lights:
      return from_lights_row[column];
    case LightSearch::both_ends:
      return both_ends_row[column];
    case LightSearch::photons:
      return photons_row[column];
    case LightSearch::none:
      break;
  }
  return std::nullopt;
}

}  // namespace montelux
