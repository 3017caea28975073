// Paths, rays or other structs of lanes that wait until lanes are free.
#pragma once
#include <array>
#include <vector>

#include "math/lane_words.h"

namespace montelux {

// The first one added is the first one taken. S<F> is made of 32-bit words alone.
template <template <class> class S, class F>
class LaneQueue {
 public:
  void reserve(std::size_t more) { waiting_.reserve(waiting_.size() + more); }
  std::size_t size() const { return waiting_.size() - next_; }
  bool is_empty() const { return size() == 0; }

  // Adds the lanes that are on, in their order.
  void add(const S<F>& pack, Mask<F> on) {
    const std::size_t before = waiting_.size();
    waiting_.resize(before + std::size_t(count(on)));
    get_lanes_words(pack, bits(on), waiting_.data() + before);
  }

  // Fills lanes that are off as long as there is something left; returns the lanes that it has filled.
  Mask<F> fill(S<F>& pack, Mask<F> on) {
    const std::uint32_t running = bits(on);
    std::uint32_t filled = 0;
    if (is_empty()) return mask_of_bits<F>(filled);
    std::array<const S<float>*, lanes_of<F>> from;
    for (int k = 0; k < lanes_of<F>; ++k) {
      const bool takes = ((running >> k) & 1u) == 0 && next_ < waiting_.size();
      from[std::size_t(k)] = &waiting_[takes ? next_ : 0];
      filled |= std::uint32_t(takes) << k;
      next_ += takes;
    }
    set_lanes_words<S<F>, S<float>>(pack, filled, from);
    if (is_empty()) waiting_.clear(), next_ = 0;
    return mask_of_bits<F>(filled);
  }

 private:
  std::vector<S<float>> waiting_;
  std::size_t next_ = 0;
};

}  // namespace montelux
