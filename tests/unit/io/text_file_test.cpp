#include "io/text_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "image/output_file.h"
#include "io/json_text.h"

namespace montelux {
namespace {

namespace fs = std::filesystem;

std::string packed(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY);
  std::string bytes(deflateBound(&stream, uLong(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = uInt(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = uInt(bytes.size());
  deflate(&stream, Z_FINISH);
  bytes.resize(stream.total_out);
  deflateEnd(&stream);
  return bytes;
}

TEST(TextFile, that_fills_the_memory_is_refused) {
  const fs::path file = fs::temp_directory_path() / "montelux-text-file.gz";
  ASSERT_TRUE(write_file(file, packed(std::string(60 << 20, ' '))));
  const Result<std::string> whole = read_whole_file(file.string());
  ASSERT_TRUE(whole) << whole.error();
  EXPECT_EQ(whole->size(), std::size_t(60) << 20);
  ASSERT_TRUE(write_file(file, packed(std::string(70 << 20, ' '))));
  const Result<std::string> bomb = read_whole_file(file.string());
  ASSERT_FALSE(bomb);
  EXPECT_NE(bomb.error().find("decompresses to more than 64 MiB"), std::string::npos) << bomb.error();
  fs::remove(file);
}

TEST(TextFile, of_a_device_is_refused) {
  EXPECT_FALSE(read_whole_file("/dev/zero"));
  EXPECT_FALSE(read_whole_file("/dev/null"));
}

TEST(Utf8, bytes_that_are_none_stand_as_numbers) {
  EXPECT_EQ(as_utf8("plain\n\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80\x7f"),
            "plain\n\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80\x7f");
  EXPECT_EQ(as_utf8("a\xff\xc3"), "a\\xff\\xc3");
  EXPECT_EQ(as_utf8("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(as_utf8("\xc0\xaf"), "\\xc0\\xaf");           // a longer form than need be
  EXPECT_EQ(without_control("a\x01\xc2\x85\xff\xc3\xa9", '?'), "a????\xc3\xa9");
}

TEST(Utf8, json_holds_any_bytes_in_strings_and_keys) {
  const nlohmann::ordered_json json{{"name", "\xff"}, {"list", {"\xc3\xa9", {{"k\xfe", 1}}}}};
  EXPECT_EQ(json_text(json), "{\"name\":\"\\\\xff\",\"list\":[\"\xc3\xa9\",{\"k\\\\xfe\":1}]}");
}

}  // namespace
}  // namespace montelux
