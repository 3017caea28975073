// Directives that change the current transform.
#include <cmath>

#include "io/pbrt/parser.h"
#include "io/text_file.h"

namespace montelux::pbrt {

namespace {

bool is_usable(const Transform& transform) {
  constexpr double max_element = 1e30;
  for (const Matrix4* m : {&transform.matrix(), &transform.inverse_matrix()})
    for (const auto& row : m->m)
      for (double x : row)
        if (!(std::abs(x) <= max_element)) return false;
  return true;
}

}  // namespace

// Changes the transforms that ActiveTransform selects.
void Parser::set_transform(const Transform& transform, bool concatenate) {
  MovingTransform& current = state_.transform;
  Transform start = concatenate ? current.start * transform : transform;
  Transform end = concatenate ? current.end * transform : transform;
  if (!is_usable(state_.change_start ? start : end))
    return report_.error(here(), "the transform cannot be inverted: it exceeds the range of numbers");
  if (state_.change_start) current.start = start;
  if (state_.change_end) current.end = end;
}

// The current transform for something that cannot move.
Transform Parser::still_transform(std::string_view owner) {
  if (state_.transform.moves())
    report_.tolerable(here(), "this " + std::string(owner) + " moves; only cameras, shapes and instances can",
                      report_.lenient() ? "it stays at its start" : "lenient reading leaves it at its start");
  return state_.transform.start;
}

// The transform at the end of something that can move, if it moves; else nothing.
std::vector<Transform> Parser::transform_at_end(std::string_view owner) {
  const MovingTransform& t = state_.transform;
  if (!t.moves()) return {};
  if (t.start.swaps_handedness() != t.end.swaps_handedness()) {
    report_.error(here(), "this " + std::string(owner) + " is mirrored during its motion",
                  "the transform mirrors at one end and not at the other");
    return {};
  }
  return {t.end};
}

void Parser::directive_identity() { set_transform(Transform(), false); }

void Parser::directive_translate() {
  std::array<double, 3> v;
  if (numbers(v)) set_transform(translate(v[0], v[1], v[2]), true);
}

void Parser::directive_scale() {
  std::array<double, 3> v;
  if (!numbers(v)) return;
  if (v[0] == 0 || v[1] == 0 || v[2] == 0)
    return report_.error(here(), "Scale by zero cannot be inverted; all three factors must differ from 0");
  set_transform(scale(v[0], v[1], v[2]), true);
}

void Parser::directive_rotate() {
  std::array<double, 4> v;
  if (!numbers(v)) return;
  if (v[1] == 0 && v[2] == 0 && v[3] == 0) return report_.error(here(), "the axis of Rotate has no length");
  set_transform(rotate(v[0], v[1], v[2], v[3]), true);
}

void Parser::directive_look_at() {
  std::array<double, 9> v;
  if (!numbers(v)) return;
  auto transform = look_at({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]});
  if (!transform)
    return report_.error(here(), "LookAt has no direction: eye and target coincide, or up is parallel to the view");
  set_transform(*transform, true);
}

// Sixteen numbers, column by column.
std::optional<Matrix4> Parser::matrix_argument() {
  std::array<double, 16> v;
  if (!numbers(v)) return std::nullopt;
  Matrix4 matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix.m[row][column] = v[std::size_t(4 * column + row)];
  return matrix;
}

void Parser::directive_transform() {
  auto matrix = matrix_argument();
  if (!matrix) return;
  auto transform = from_matrix(*matrix);
  if (!transform) return report_.error(here(), "the matrix of Transform is singular");
  set_transform(*transform, false);
}

void Parser::directive_concat_transform() {
  auto matrix = matrix_argument();
  if (!matrix) return;
  auto transform = from_matrix(*matrix);
  if (!transform) return report_.error(here(), "the matrix of ConcatTransform is singular");
  set_transform(*transform, true);
}

void Parser::directive_coordinate_system() {
  if (auto name = quoted_argument("a name")) coordinate_systems_[*name] = state_.transform;
}

void Parser::directive_coord_sys_transform() {
  auto name = quoted_argument("the name of a coordinate system");
  if (!name) return;
  auto found = coordinate_systems_.find(*name);
  if (found != coordinate_systems_.end()) {
    state_.transform = found->second;
    return;
  }
  std::vector<std::string_view> names;
  for (const auto& [known, transform] : coordinate_systems_) names.push_back(known);
  std::string_view near = nearest_name(*name, names);
  report_.error(here(), "there is no coordinate system '" + printable(*name) + "'",
                near.empty() ? "" : "did you mean '" + std::string(near) + "'?");
}

void Parser::directive_active_transform() {
  auto which = word_argument({"StartTime", "EndTime", "All"});
  if (!which) return;
  state_.change_start = *which != "EndTime";
  state_.change_end = *which != "StartTime";
}

void Parser::directive_transform_times() {
  std::array<double, 2> times;
  if (!numbers(times) || !is_in_world(false)) return;
  if (!(times[0] < times[1])) return report_.error(here(), "TransformTimes takes a start and a later end");
  scene_.transforms_start = times[0], scene_.transforms_end = times[1];
}

void Parser::directive_transform_end() {
  if (auto block = close_block("TransformBegin", "TransformEnd")) {
    state_.transform = block->state.transform;
    state_.change_start = block->state.change_start;
    state_.change_end = block->state.change_end;
  }
}

}  // namespace montelux::pbrt
