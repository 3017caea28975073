#include "lab/integral/state.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace montelux::lab {
namespace {

using Json = nlohmann::json;

constexpr int format_version = 3;

Json to_value(const PassRecord& p) {
  return {p.seed,
          p.index,
          p.samples,
          p.sum,
          p.m2,
          p.own_variance,
          p.control_sum,
          p.control_squares,
          p.control_products,
          p.outside.uniform,
          p.outside.map,
          p.outside.uniform_magnitude,
          p.outside.map_magnitude,
          p.magnitude};
}

// An integer in [low, high], or a number in that range: a file may have been changed.
std::uint64_t whole(const Json& j, const char* what, std::uint64_t low, std::uint64_t high) {
  if (!j.is_number_unsigned() || j.get<std::uint64_t>() < low || j.get<std::uint64_t>() > high)
    throw std::invalid_argument(
        fmt::format("the state of an integral: {} is {}, not a whole number from {} to {}", what, j.dump(), low, high));
  return j;
}
double number(const Json& j, const char* what, double low = -std::numeric_limits<double>::max()) {
  if (!j.is_number() || !std::isfinite(j.get<double>()) || j.get<double>() < low)
    throw std::invalid_argument(fmt::format("the state of an integral: {} is {}, not a finite number{}", what, j.dump(),
                                            low == 0 ? " from 0" : ""));
  return j;
}

constexpr std::uint64_t max_count = std::uint64_t(1) << 62;

PassRecord pass_from(const Json& j) {
  if (!j.is_array() || j.size() != 14) throw std::invalid_argument("the state of an integral: a pass has 14 fields");
  PassRecord p;
  p.seed = whole(j[0], "the seed of a pass", 0, max_count);
  p.index = std::uint32_t(whole(j[1], "the number of a pass", 0, max_passes - 1));
  p.samples = whole(j[2], "the samples of a pass", 1, max_samples_of_pass);
  p.sum = number(j[3], "the sum of a pass"), p.m2 = number(j[4], "the squares of a pass", 0);
  p.own_variance = number(j[5], "the variance of a pass", 0);
  p.control_sum = number(j[6], "the control sum of a pass");
  p.control_squares = number(j[7], "the control squares of a pass", 0);
  p.control_products = number(j[8], "the control products of a pass");
  p.outside = {number(j[9], "an outside sum"), number(j[10], "an outside sum"), number(j[11], "an outside sum", 0),
               number(j[12], "an outside sum", 0)};
  p.magnitude = number(j[13], "the magnitude of a pass", 0);
  return p;
}

TailProbe probe_from(const Json& j) {
  if (j.is_null()) return {};
  if (!j.is_array() || j.size() != 3) throw std::invalid_argument("the state of an integral: a probe has 3 fields");
  TailProbe p{true, number(j[0], "the exponent of a probe", 0), std::numeric_limits<double>::infinity()};
  p.terms = whole(j[1], "the terms of a probe", 0, LargestTerms::of_run);
  if (p.exponent > 0) p.index = number(j[2], "the index of a probe", 0);
  return p;
}

// Rejects counts that no run can have. (The chains of metropolis use slightly fewer samples than
// planned.)
void check_counts(const IntegralState& s) {
  std::uint64_t samples = 0;
  for (const PassRecord& p : s.passes) samples += p.samples;
  const bool counted =
      s.training_evaluations <= s.evaluations && samples / 2 <= s.evaluations && s.accepted <= s.proposed;
  if (!counted) throw std::invalid_argument("the state of an integral: its counts contradict each other");
}

}  // namespace

std::string to_json(const IntegralState& s) {
  Json passes = Json::array();
  for (const PassRecord& p : s.passes) passes.push_back(to_value(p));
  const Json j{
      {"format", "montelux integral"},
      {"version", format_version},
      {"method", to_text(s.method)},
      {"dimension", s.dimension},
      {"seed", s.seed},
      {"training_samples", s.training_samples},
      {"training_evaluations", s.training_evaluations},
      {"evaluations", s.evaluations},
      {"non_finite", s.non_finite},
      {"seconds", s.seconds},
      {"looks", s.looks},
      {"proposed", s.proposed},
      {"accepted", s.accepted},
      {"pass_fields",
       {"seed", "index", "samples", "sum", "m2", "own_variance", "control_sum", "control_squares", "control_products",
        "outside_uniform", "outside_map", "outside_uniform_magnitude", "outside_map_magnitude", "magnitude"}},
      {"passes", passes},
      {"largest_terms", s.largest.sorted()},
      {"probe",
       s.probe.known ? Json{s.probe.exponent, s.probe.terms, s.probe.exponent > 0 ? s.probe.index : 0} : Json()}};
  return j.dump(1);
}

IntegralState state_from_json(std::string_view text) {
  try {
    const Json j = Json::parse(text);
    if (j.at("format") != "montelux integral") throw std::invalid_argument("this is not the state of an integral");
    if (j.at("version") != format_version)
      throw std::invalid_argument(
          fmt::format("the state has version {}; version {} can be read", j.at("version").dump(), format_version));
    IntegralState s;
    const auto method = parse_method(j.at("method").get<std::string>());
    if (!method) throw std::invalid_argument("the state of an integral: " + method.error());
    s.method = *method;
    const auto count = [&](const char* name, std::uint64_t high = max_count) {
      return whole(j.at(name), name, 0, high);
    };
    s.dimension = whole(j.at("dimension"), "dimension", 1, 64), s.seed = count("seed");
    s.training_samples = count("training_samples", max_samples_of_pass);
    s.training_evaluations = count("training_evaluations");
    s.evaluations = count("evaluations"), s.non_finite = count("non_finite");
    s.seconds = number(j.at("seconds"), "seconds", 0), s.looks = int(count("looks", 1u << 20));
    s.proposed = count("proposed"), s.accepted = count("accepted");
    for (const Json& p : j.at("passes")) s.passes.push_back(pass_from(p));
    std::vector<double> largest;
    for (const Json& x : j.at("largest_terms")) largest.push_back(number(x, "a largest term", 0));
    s.largest = LargestTerms::from(largest, LargestTerms::of_run);
    s.probe = probe_from(j.at("probe"));
    check_counts(s);
    return s;
  } catch (const Json::exception&) {
    throw std::invalid_argument("the state of an integral is damaged: an entry of it is missing or of another type");
  }
}

IntegralState merge(const std::vector<IntegralState>& states) {
  if (states.empty()) throw std::invalid_argument("there are no states to merge");
  IntegralState total = states.front();
  for (std::size_t i = 1; i < states.size(); ++i) {
    const IntegralState& s = states[i];
    if (to_text(s.method) != to_text(total.method))
      throw std::invalid_argument(fmt::format("states of different methods cannot be merged ({} and {})",
                                              to_text(total.method), to_text(s.method)));
    if (s.dimension != total.dimension)
      throw std::invalid_argument(
          fmt::format("states of {} and {} dimensions cannot be merged", total.dimension, s.dimension));
    total.training_evaluations += s.training_evaluations;
    total.evaluations += s.evaluations, total.non_finite += s.non_finite, total.seconds += s.seconds;
    total.looks += s.looks, total.proposed += s.proposed, total.accepted += s.accepted;
    total.passes.insert(total.passes.end(), s.passes.begin(), s.passes.end());
    total.largest.merge(s.largest);
  }
  std::set<std::pair<std::uint64_t, std::uint32_t>> seen;
  for (const PassRecord& p : total.passes)
    if (!seen.insert({p.seed, p.index}).second)
      throw std::invalid_argument(
          fmt::format("the states share the passes of seed {}; merged runs need different seeds", p.seed));
  return total;
}

}  // namespace montelux::lab
