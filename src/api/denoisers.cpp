#include "api/denoisers.h"

#include "denoise/oidn.h"
#include "parameter/choice.h"
#include "parameter/fields.h"

namespace montelux {

namespace {

struct OidnSettings {
  std::string file;
};

Fields<OidnSettings> oidn_fields() {
  Fields<OidnSettings> fields;
  fields.words("library", &OidnSettings::file, "file of the library; default: libOpenImageDenoise.so of the system");
  return fields;
}

// A filter of the table, and the settings of one that has some.
struct NamedDenoiser {
  bool is_ours;
  OidnSettings oidn;
};

Result<NamedDenoiser> denoiser_named(std::string_view text) {
  const Result<ChoiceText> choice = parse_choice(text);
  if (!choice) return choice.failure();
  const EntitySpec* spec = find_entity(denoiser_table(), choice->name);
  if (!spec) return unknown_name("denoiser", choice->name, names_of(denoiser_table()));
  const Result<ParameterList> list = read_settings(*spec, choice->settings, "denoiser");
  if (!list) return list.failure();
  NamedDenoiser named{spec == denoiser_table().data(), {}};
  if (Status read = oidn_fields().read(*list, named.oidn); !read) return read.failure();
  return named;
}

}  // namespace

std::span<const EntitySpec> denoiser_table() {
  static const std::vector<EntitySpec> table = {
      {"montelux", "filter by both halves of the passes, which knows its error and keeps what it cannot improve", {}},
      {"oidn", "Intel's Open Image Denoise, where it is installed; what is left of the error is measured by the halves",
       oidn_fields().specs({})}};
  return table;
}

std::vector<std::pair<std::string, std::string>> denoiser_names() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const EntitySpec& spec : denoiser_table()) names.emplace_back(spec.name, spec.meaning);
  return names;
}

Status check_denoiser(std::string_view text) {
  const Result<NamedDenoiser> named = denoiser_named(text);
  return named ? Status(Done{}) : named.failure();
}

Result<std::shared_ptr<const ColorFilter>> parse_denoiser(std::string_view text) {
  const Result<NamedDenoiser> named = denoiser_named(text);
  if (!named) return named.failure();
  if (named->is_ours) return std::shared_ptr<const ColorFilter>();
  return load_oidn(named->oidn.file);
}

}  // namespace montelux
