// A tabulated reflection (Dupuy and Jakob 2018), whose table is not in the row: the row has its address.
#pragma once
#include "material/bsdf.h"
#include "material/lobe.h"
#include "material/parts.h"

namespace montelux {

class MeasuredTable;

// An address in a row: numbers of 22 bits, which a float holds exactly and every copy, gather and select keeps. Zero:
// none. What owns the row owns the object, too.
struct AddressSlots {
  static constexpr int size = 3, bits = 22;
};
template <class T>
void put_address(const T* address, float* slots) {
  static_assert(AddressSlots::size * AddressSlots::bits >= 8 * sizeof(address));
  auto rest = std::uint64_t(reinterpret_cast<std::uintptr_t>(address));
  for (int i = 0; i < AddressSlots::size; ++i, rest >>= AddressSlots::bits)
    slots[i] = float(rest & ((1u << AddressSlots::bits) - 1));
}
template <class T>
const T* address_in(const float* slots) {
  std::uint64_t address = 0;
  for (int i = AddressSlots::size; i-- > 0;) address = address << AddressSlots::bits | std::uint64_t(slots[i]);
  return reinterpret_cast<const T*>(std::uintptr_t(address));
}

struct MeasuredSlots {
  static constexpr int table = 0, end = table + AddressSlots::size;
  static_assert(fill_bsdf_row(end, {{table, AddressSlots::size}}));
};

// Of one lane; the table must exist. Directions on either side of the surface, which reflects alike on both.
BsdfValue<float> evaluate_measured(const MeasuredTable& table, Vec3f wo, Vec3f wi, TransportMode mode);
struct MeasuredSample {
  Vec3f wi;
  BsdfValue<float> value;  // zero below the surface
};
bool is_anisotropic(const MeasuredTable* table);  // false without a table
MeasuredSample sample_measured(const MeasuredTable& table, Vec3f wo, Vec2f u, TransportMode mode);

// A tabulated reflection, of both sides alike.
struct MeasuredDesc {
  std::string file{};  // *.bsdf of the RGL material database

  static constexpr std::string_view meaning = "a tabulated reflection (Dupuy and Jakob 2018), the same on both sides";
  static Fields<MeasuredDesc> rows();
  void fill(RowBuilder& row) const;
  bool operator==(const MeasuredDesc&) const = default;
};

// f as tabulated for wo, which need not be reciprocal: importance scatters from wo to wi by f(wi, wo). No light passes
// the surface. A row without a table is black. Lanes are looked up one after the other.
template <class F>
class Measured {
 public:
  static constexpr std::string_view name = "measured";
  static constexpr bool has_reflection = true, has_transmission = false;
  static constexpr int slot_count = MeasuredSlots::end;
  using Stated = MeasuredDesc;
  static constexpr auto facet_slots = no_facets;

  static bool has_grain(const BsdfRows<float>& rows) { return is_anisotropic(Measured<float>(rows).table_of(0)); }

  MONTELUX_INLINE explicit Measured(const BsdfRows<F>& rows) {
    for (int i = 0; i < AddressSlots::size; ++i) address_[i] = rows.number(MeasuredSlots::table + i);
  }

  MONTELUX_INLINE Mask<F> is_delta() const { return Mask<F>(false); }

  BsdfValue<F> evaluate(Vec3<F> wo, Vec3<F> wi, const BsdfContext<F>& context) const {
    BsdfValue<F> all{gray(F(0.0f)), {F(0.0f)}};
    for_each_lane(context.on & same_side(wo, wi), [&](int k) {
      const MeasuredTable* table = table_of(k);
      if (!table) return;
      const BsdfValue<float> value = evaluate_measured(*table, lane(wo, k), lane(wi, k), context.mode);
      set_lane(all.f_cos, k, value.f_cos);
      set_lane(all.density.value, k, value.density.value);
    });
    return all;
  }
  BsdfSample<F> sample(Vec3<F> wo, F, Vec2<F> u2, const BsdfContext<F>& context) const {
    Vec3<F> wi{F(0.0f), F(0.0f), F(0.0f)};
    BsdfValue<F> value{gray(F(0.0f)), {F(0.0f)}};
    for_each_lane(context.on & (wo.z != F(0.0f)), [&](int k) {
      const MeasuredTable* table = table_of(k);
      if (!table) return;
      const MeasuredSample sample = sample_measured(*table, lane(wo, k), lane(u2, k), context.mode);
      set_lane(wi, k, sample.wi);
      set_lane(value.f_cos, k, sample.value.f_cos);
      set_lane(value.density.value, k, sample.value.density.value);
    });
    const Mask<F> valid = value.density.value > F(0.0f);
    return {wi, value.f_cos / max(value.density.value, F(1e-30f)), value.density, F(1.0f), valid, Mask<F>(false)};
  }

  // Of a lane.
  const MeasuredTable* table_of(int k) const {
    float slots[AddressSlots::size];
    for (int i = 0; i < AddressSlots::size; ++i) slots[i] = lane(address_[i], k);
    return address_in<MeasuredTable>(slots);
  }

 private:
  F address_[AddressSlots::size];
};

}  // namespace montelux
