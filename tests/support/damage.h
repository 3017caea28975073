// Damage to texts and bytes by a seed, for tests of what reads them.
#pragma once
#include <algorithm>
#include <array>
#include <cctype>
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace montelux::test {

using DamageRandom = std::mt19937;

inline std::size_t below(DamageRandom& random, std::size_t n) { return n == 0 ? 0 : random() % n; }

// Words that mean something to one reader or another.
inline constexpr std::array<std::string_view, 36> damage_words{"[",
                                                               "]",
                                                               "\"",
                                                               "\"\"",
                                                               "#",
                                                               "\\",
                                                               "-1",
                                                               "1e999",
                                                               "nan",
                                                               "0",
                                                               "99999999999",
                                                               "Shape",
                                                               "\n",
                                                               "WorldBegin",
                                                               "AttributeEnd",
                                                               "ObjectBegin \"x\"",
                                                               "ObjectEnd",
                                                               "\"rgb L\"",
                                                               "true",
                                                               "\"texture u\"",
                                                               "Include \".\"",
                                                               "[ 1 2",
                                                               "65536",
                                                               "\xff\xfe",
                                                               "{",
                                                               "}",
                                                               "null",
                                                               ":",
                                                               "--",
                                                               "=",
                                                               ",",
                                                               "1e-320",
                                                               "-0",
                                                               "4294967296",
                                                               "(",
                                                               ")"};
inline constexpr std::array<std::string_view, 16> extreme_numbers{
    "0",     "-1",  "1",   "2147483647", "-2147483648", "4294967295", "9223372036854775808", "1e308", "1e39", "-1e39",
    "1e-45", "nan", "inf", "0.5",        "1e7",         "255"};

// The number that begins at or behind `at` becomes an extreme one.
inline void damage_number(std::string& text, std::size_t at, DamageRandom& random) {
  const auto is_part = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '.' || c == '-'; };
  const auto begin = std::find_if(text.begin() + std::ptrdiff_t(std::min(at, text.size())), text.end(), is_part);
  const auto end = std::find_if_not(begin, text.end(), is_part);
  if (begin != end) text.replace(begin, end, extreme_numbers[below(random, extreme_numbers.size())]);
}

// One act of damage: a byte, a bit, a cut, a copy, a word, a number, a swap of two parts, the end left out, or a part
// of another text where there are others.
inline void damage(std::string& text, DamageRandom& random, std::span<const std::string> others = {}) {
  const std::size_t at = below(random, text.size());
  const std::size_t length = below(random, 40);
  switch (random() % 9) {
    case 0:
      if (!text.empty()) text[at] = static_cast<char>(random() & 255);
      break;
    case 1:
      if (!text.empty()) text[at] = static_cast<char>(text[at] ^ (1 << (random() & 7)));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, damage_words[below(random, damage_words.size())]);
      break;
    case 4:
      text.insert(at, text.substr(below(random, text.size()), length));
      break;
    case 5:
      if (random() % 4 == 0) text.resize(at);
      break;
    case 6:
      damage_number(text, at, random);
      break;
    case 7:
      if (!others.empty()) {
        const std::string& other = others[below(random, others.size())];
        text.insert(at, other.substr(below(random, other.size()), 4 * length));
      }
      break;
    default:
      text.replace(at, std::min(length, text.size() - at), damage_words[below(random, damage_words.size())]);
  }
}

}  // namespace montelux::test
