// PLY files of every kind, whole and damaged.
#include "io/ply.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "temporary_folder.h"

namespace montelux {
namespace {

struct Outcome {
  std::optional<Mesh> mesh;
  Diagnostics diagnostics;
};
Outcome read(const std::string& bytes) {
  Outcome outcome;
  outcome.mesh = read_ply_bytes(bytes, "mesh.ply", {}, outcome.diagnostics);
  return outcome;
}

// Appends numbers in the wanted byte order.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}
  template <class T>
  Bytes& add(T value) {
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    text += raw;
    return *this;
  }
  std::string text;

 private:
  bool big_endian_;
};

std::string header(const std::string& format, int vertices, int faces) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty double z\nproperty uchar quality\nproperty float u\n"
         "property float v\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nproperty short tag\nend_header\n";
}
std::string binary_mesh(bool big_endian) {
  Bytes bytes(big_endian);
  const float xy[5][2]{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5f, 2}};
  for (const auto& p : xy) bytes.add(p[0]).add(p[1]).add(0.25).add(std::uint8_t{7}).add(p[0]).add(p[1]);
  bytes.add(std::uint8_t{3}).add(0).add(1).add(2).add(std::int16_t{1});
  bytes.add(std::uint8_t{4}).add(0).add(1).add(2).add(3).add(std::int16_t{2});
  bytes.add(std::uint8_t{5}).add(0).add(1).add(2).add(4).add(3).add(std::int16_t{3});
  return header(big_endian ? "binary_big_endian" : "binary_little_endian", 5, 3) + bytes.text;
}
void expect_mesh(const Outcome& outcome) {
  ASSERT_TRUE(outcome.mesh) << outcome.diagnostics.all().front().message;
  const Mesh& mesh = *outcome.mesh;
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.positions[2].y, 1);
  EXPECT_EQ(mesh.positions[2].z, 0.25f);
  ASSERT_EQ(mesh.uvs.size(), 5u);
  EXPECT_EQ(mesh.uvs[4].x, 0.5f);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 0, 2, 4, 0, 4, 3}));
  EXPECT_EQ(mesh.quads, (std::vector<std::uint32_t>{0, 1, 3, 2}));
  ASSERT_EQ(outcome.diagnostics.all().size(), 1u);
  EXPECT_EQ(outcome.diagnostics.all().front().severity, Severity::note);
}

TEST(Ply, little_endian_gives_the_mesh) { expect_mesh(read(binary_mesh(false))); }
TEST(Ply, big_endian_gives_the_same_mesh) { expect_mesh(read(binary_mesh(true))); }
TEST(Ply, text_gives_the_same_mesh) {
  expect_mesh(read(header("ascii", 5, 3) +
                   "0 0 .25 7 0 0\n1 0 .25 7 1 0\n1 1 .25 7 1 1\n0 1 .25 7 0 1\n0.5 2 .25 7 0.5 2\n"
                   "3 0 1 2 1\n4 0 1 2 3 2\n5 0 1 2 4 3 3\n"));
}
TEST(Ply, faces_without_area_are_dropped_with_their_number) {
  Outcome outcome = read(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 3\n"
      "property list uchar int vertex_index\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2 3 0 1 1 2 0 1\n");
  ASSERT_TRUE(outcome.mesh);
  EXPECT_EQ(outcome.mesh->triangles.size(), 3u);
  ASSERT_EQ(outcome.diagnostics.all().size(), 1u);
  EXPECT_EQ(outcome.diagnostics.all().front().message.substr(0, 8), "2 faces ");
}
TEST(Ply, reads_from_a_file) {
  test::TemporaryFolder folder;
  Outcome outcome;
  outcome.mesh = read_ply(folder.write("mesh.ply", binary_mesh(false)), {}, outcome.diagnostics);
  expect_mesh(outcome);
  EXPECT_FALSE(read_ply(folder.path() + "/none.ply", {}, outcome.diagnostics));
}
TEST(Ply, every_truncation_is_an_error) {
  for (bool big_endian : {false, true}) {
    std::string whole = binary_mesh(big_endian);
    for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(read(whole.substr(0, size)).mesh) << size;
  }
}
TEST(Ply, a_lying_header_allocates_nothing) {
  std::string text = binary_mesh(false);
  for (std::string_view count : {"vertex 4000000000000000000", "face 4000000000000000000"}) {
    std::string lie = text;
    std::size_t at = lie.find(count.substr(0, count.find(' ') + 1));
    std::size_t end = lie.find('\n', at);
    Outcome outcome = read(lie.replace(at, end - at, count));
    EXPECT_FALSE(outcome.mesh);
    EXPECT_NE(outcome.diagnostics.all().front().message.find("more than its bytes can contain"), std::string::npos);
  }
}
TEST(Ply, damage_is_named) {
  struct Case {
    std::string from, to, message;
  };
  std::string text = header("ascii", 3, 1) + "0 0 0 0 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2 0\n";
  for (const Case& c : std::vector<Case>{{"ply\n", "plz\n", "does not begin"},
                                         {"ascii", "binary", "unknown format"},
                                         {"float x", "flout x", "unknown type"},
                                         {"float x", "float w", "have no x, y or z"},
                                         {"vertex_indices", "corners", "lack the list"},
                                         {"3 0 1 2 0", "3 0 1 3 0", "names vertex 3 of 3"},
                                         {"3 0 1 2 0", "3 0 1 -2 0", "names vertex -1 of 3"},
                                         {"1 0 0 0 1 0", "nan 0 0 0 1 0", "not finite"},
                                         {"1 0 0 0 1 0", "one 0 0 0 1 0", "invalid number"},
                                         {"end_header", "and_header", "unknown word"}}) {
    std::string damaged = text;
    damaged.replace(damaged.find(c.from), c.from.size(), c.to);
    Outcome outcome = read(damaged);
    EXPECT_FALSE(outcome.mesh) << c.message;
    ASSERT_EQ(outcome.diagnostics.errors(), 1);
    EXPECT_NE(outcome.diagnostics.all().front().message.find(c.message), std::string::npos)
        << outcome.diagnostics.all().front().message << " instead of " << c.message;
  }
}

}  // namespace
}  // namespace montelux
