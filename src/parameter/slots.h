// Rows of numbers in which models keep their parameters: which slots a parameter has.
#pragma once
#include <initializer_list>

namespace montelux {

struct SlotRange {
  int first, size;
};

// Whether parameters, in the order of their slots, take every slot from `first` up to `end` once.
constexpr bool fill_slots(int first, int end, std::initializer_list<SlotRange> parameters) {
  for (const SlotRange& p : parameters) {
    if (p.first != first) return false;
    first += p.size;
  }
  return first == end;
}

}  // namespace montelux
