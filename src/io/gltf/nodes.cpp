#include "io/gltf/nodes.h"

#include <algorithm>
#include <cmath>

namespace montelux::gltf {

namespace {

LocalPose read_pose(const Element& node) {
  LocalPose pose;
  if (const auto m = node["matrix"].numbers(16)) {
    Matrix4 matrix;
    for (std::size_t i = 0; i < 16; ++i) matrix.m[i % 4][i / 4] = (*m)[i];
    if (matrix.m[3] != std::array<double, 4>{0, 0, 0, 1})
      node["matrix"].error("the last row of the matrix must be 0 0 0 1: numbers 4, 8, 12 and 16");
    else
      pose.fixed = matrix;
  }
  if (const auto t = node["translation"].numbers(3)) std::copy_n(t->begin(), 3, pose.translation.begin());
  if (const auto s = node["scale"].numbers(3)) std::copy_n(s->begin(), 3, pose.scale.begin());
  if (const auto q = node["rotation"].numbers(4)) {
    const double length = std::sqrt((*q)[0] * (*q)[0] + (*q)[1] * (*q)[1] + (*q)[2] * (*q)[2] + (*q)[3] * (*q)[3]);
    if (length > 1e-6)
      for (std::size_t i = 0; i < 4; ++i) pose.rotation[i] = (*q)[i] / length;
    else
      node["rotation"].error("a quaternion must not be zero");
  }
  return pose;
}

Node read_node(Document& document, const Element& element) {
  Node node{element, element["name"].text().value_or(""), {}, {}, read_pose(element), {}, {}, {}, {}, {}};
  const Element nodes = document.list("nodes"), children = element["children"];
  for (std::size_t i = 0; i < children.size(); ++i)
    if (const auto child = children[i].index_of(nodes, "a node")) node.children.push_back(*child);
  node.mesh = element["mesh"].index_of(document.list("meshes"), "a mesh");
  node.camera = element["camera"].index_of(document.list("cameras"), "a camera");
  node.skin = element["skin"].index_of(document.list("skins"), "a skin");
  if (const Element light = element["extensions"]["KHR_lights_punctual"])
    node.light =
        light.required("light").index_of(document.root()["extensions"]["KHR_lights_punctual"]["lights"], "a light");
  if (const Element weights = element["weights"])
    for (std::size_t i = 0; i < weights.size(); ++i) node.weights.push_back(weights[i].number().value_or(0));
  return node;
}

// Keeps at most one parent per node.
void link_parents(std::vector<Node>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    std::vector<std::size_t> kept;
    for (std::size_t child : nodes[i].children)
      if (nodes[child].parent) {
        nodes[i].element["children"].error("node " + std::to_string(child) + " already has another parent, node " +
                                           std::to_string(*nodes[child].parent));
      } else {
        nodes[child].parent = i;
        kept.push_back(child);
      }
    nodes[i].children = std::move(kept);
  }
}

// From `roots` downward, parents first.
std::vector<std::size_t> order_from(const std::vector<Node>& nodes, std::vector<std::size_t> roots) {
  std::vector<std::size_t> order = std::move(roots);
  for (std::size_t next = 0; next < order.size(); ++next)
    order.insert(order.end(), nodes[order[next]].children.begin(), nodes[order[next]].children.end());
  return order;
}

// The root nodes of the scene that is shown.
std::vector<std::size_t> roots_of(Document& document, NodeTree& tree) {
  const Element scenes = document.list("scenes"), nodes = document.list("nodes");
  std::vector<std::size_t> roots;
  if (scenes.size() == 0) {
    for (std::size_t i = 0; i < tree.nodes.size(); ++i)
      if (!tree.nodes[i].parent) roots.push_back(i);
    return roots;
  }
  tree.scene = scenes[document.root()["scene"].index_of(scenes, "a scene").value_or(0)];
  if (scenes.size() > 1)
    document.report().note(document.whole(), "the file has " + std::to_string(scenes.size()) + " scenes; the one at " +
                                                 tree.scene.pointer() + " is shown");
  const Element list = tree.scene["nodes"];
  std::set<std::size_t> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto node = list[i].index_of(nodes, "a node");
    if (!node) continue;
    if (tree.nodes[*node].parent)
      list[i].error("node " + std::to_string(*node) + " is not a root: it is a child of node " +
                    std::to_string(*tree.nodes[*node].parent));
    else if (seen.insert(*node).second)
      roots.push_back(*node);
  }
  return roots;
}

}  // namespace

Matrix4 LocalPose::matrix() const {
  if (fixed) return *fixed;
  const double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
  const double r[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  Matrix4 m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m.m[i][j] = r[i][j] * scale[j];
    m.m[i][3] = translation[i];
  }
  return m;
}

std::vector<LocalPose> NodeTree::poses() const {
  std::vector<LocalPose> list;
  for (const Node& node : nodes) list.push_back(node.pose);
  return list;
}

std::vector<Matrix4> NodeTree::world_matrices(const std::vector<LocalPose>& poses) const {
  std::vector<Matrix4> world(nodes.size());
  for (std::size_t i : ordered_) {
    const Matrix4 local = poses[i].matrix();
    world[i] = nodes[i].parent ? world[*nodes[i].parent] * local : local;
  }
  return world;
}

NodeTree read_nodes(Document& document) {
  const Element list = document.list("nodes");
  NodeTree tree(document.list("scenes")[std::size_t(0)]);
  for (std::size_t i = 0; i < list.size(); ++i) tree.nodes.push_back(read_node(document, list[i]));
  link_parents(tree.nodes);
  std::vector<std::size_t> tops;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i)
    if (!tree.nodes[i].parent) tops.push_back(i);
  tree.ordered_ = order_from(tree.nodes, std::move(tops));
  // Nodes that cannot be reached from a root form a cycle.
  if (tree.ordered_.size() < tree.nodes.size()) {
    std::vector<bool> reached(tree.nodes.size());
    for (std::size_t i : tree.ordered_) reached[i] = true;
    const std::size_t first = std::size_t(std::find(reached.begin(), reached.end(), false) - reached.begin());
    list[first]["children"].error("node " + std::to_string(first) +
                                  " is its own descendant, or a descendant of such a node");
  }
  tree.shown = order_from(tree.nodes, roots_of(document, tree));
  return tree;
}

}  // namespace montelux::gltf
