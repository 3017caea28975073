// How an image was shown, as stated in results.
#pragma once
#include "api/images.h"

namespace montelux::cli {

// {"content": "light", "exposure": -12.3, "range": null, "colormap": null, "automatic": true}: exposure in stops, null
// if a range shows the values; automatic: exposure or range was chosen automatically.
template <class Json>
Json display_json(const ChosenDisplay& chosen) {
  const DisplayTransform& t = chosen.transform;
  Json json;
  json["content"] = content_names[std::size_t(t.content)];
  json["exposure"] = nullptr, json["range"] = nullptr, json["colormap"] = nullptr;
  if (t.content == Content::light && !t.range) json["exposure"] = t.exposure;
  if (t.range) json["range"] = {t.range->low, t.range->high};
  if (t.map) json["colormap"] = color_map_names[std::size_t(*t.map)];
  json["automatic"] = chosen.exposure_chosen || chosen.range_chosen;
  return json;
}

}  // namespace montelux::cli
