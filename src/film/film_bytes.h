// A film as bytes, tile by tile: docs/formats.md describes them.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "film/sample_count.h"
#include "math/exact_sum.h"

namespace montelux {

class ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : out_(out) {}
  // In groups of seven bits, the low ones first; every byte but the last one has its high bit set.
  void count(std::uint64_t x);
  // Whole numbers of samples as counts; others as counts of their units, beyond all of these.
  void samples(const SampleCount& x);
  // The eight bytes of the number, the low ones first.
  void real(double x);
  // Without zeros at the low end and copies of the sign at the high end.
  void sum(const ExactSum& x);
  void sum(const SmallExactSum& x);
  void sum(const ExactProducts& x);

 private:
  std::string& out_;
};

// Reads the bytes of a ByteWriter; throws std::invalid_argument if they cannot be its bytes.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}
  bool at_end() const { return rest_.empty(); }
  std::uint64_t count(std::uint64_t max);
  // At most so many whole ones.
  SampleCount samples(std::uint64_t max);
  double real();
  // `terms`: at most so many numbers below ExactSum::largest were added; a larger sum is an error.
  ExactSum sum(std::uint64_t terms);
  SmallExactSum small_sum();
  ExactProducts products();

 private:
  unsigned char byte();
  void words(std::span<std::uint64_t> words);

  std::string_view rest_;
};

}  // namespace montelux
