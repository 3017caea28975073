#include "parameter/value.h"

namespace montelux {

const Parameter* ParameterList::find(std::string_view name) const {
  for (auto p = list_.rbegin(); p != list_.rend(); ++p)
    if (p->name == name) {
      p->used = true;
      return &*p;
    }
  return nullptr;
}

std::vector<const Parameter*> ParameterList::unused() const {
  std::vector<const Parameter*> list;
  for (const Parameter& p : list_)
    if (!p.used) list.push_back(&p);
  return list;
}
void ParameterList::forget_uses() const {
  for (const Parameter& p : list_) p.used = false;
}
void ParameterList::forget_use(std::string_view name) const {
  for (const Parameter& p : list_)
    if (p.name == name) p.used = false;
}
void ParameterList::use_all() const {
  for (const Parameter& p : list_) p.used = true;
}

namespace {

// The first value of the named array, if there is one of this type.
template <class T>
std::optional<T> first(const ParameterList& list, std::string_view name) {
  const std::vector<T>& values = list.array<T>(name);
  if (values.empty()) return std::nullopt;
  return values.front();
}

}  // namespace

float ParameterList::number(std::string_view name, float otherwise) const {
  return first<float>(*this, name).value_or(otherwise);
}
int ParameterList::integer(std::string_view name, int otherwise) const {
  return first<int>(*this, name).value_or(otherwise);
}
bool ParameterList::boolean(std::string_view name, bool otherwise) const {
  return first<std::uint8_t>(*this, name).value_or(otherwise) != 0;
}
std::string ParameterList::string(std::string_view name, std::string otherwise) const {
  return first<std::string>(*this, name).value_or(std::move(otherwise));
}
Vec3f ParameterList::vec3(std::string_view name, Vec3f otherwise) const {
  return first<Vec3f>(*this, name).value_or(otherwise);
}
std::optional<SpectrumValue> ParameterList::spectrum(std::string_view name) const {
  return first<SpectrumValue>(*this, name);
}
std::optional<std::string> ParameterList::texture(std::string_view name) const {
  const Parameter* p = find(name);
  const TextureName* texture = p ? std::get_if<TextureName>(&p->values) : nullptr;
  if (!texture) return std::nullopt;
  return texture->name;
}

}  // namespace montelux
