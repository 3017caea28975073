#include "lab/integral/state.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace montelux::lab {
namespace {

using Json = nlohmann::json;

constexpr int format_version = 1;

Json to_value(const PassRecord& p) {
  return {p.seed,        p.index,           p.samples,         p.sum, p.m2, p.own_variance,
          p.control_sum, p.control_squares, p.control_products};
}
PassRecord pass_from(const Json& j) {
  PassRecord p;
  p.seed = j.at(0), p.index = j.at(1), p.samples = j.at(2), p.sum = j.at(3), p.m2 = j.at(4);
  p.own_variance = j.at(5);
  p.control_sum = j.at(6), p.control_squares = j.at(7), p.control_products = j.at(8);
  return p;
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
       {"seed", "index", "samples", "sum", "m2", "own_variance", "control_sum", "control_squares", "control_products"}},
      {"passes", passes},
      {"largest_terms", s.largest.sorted()}};
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
    s.dimension = j.at("dimension"), s.seed = j.at("seed");
    s.training_samples = j.at("training_samples"), s.training_evaluations = j.at("training_evaluations");
    s.evaluations = j.at("evaluations"), s.non_finite = j.at("non_finite"), s.seconds = j.at("seconds");
    s.looks = j.at("looks"), s.proposed = j.at("proposed"), s.accepted = j.at("accepted");
    for (const Json& p : j.at("passes")) s.passes.push_back(pass_from(p));
    s.largest = LargestTerms::from(j.at("largest_terms").get<std::vector<double>>());
    return s;
  } catch (const Json::exception& e) {
    throw std::invalid_argument(fmt::format("the state of an integral cannot be read: {}", e.what()));
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
