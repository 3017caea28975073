#include "image/output_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace montelux {
namespace {

namespace fs = std::filesystem;

// A folder of its own for each test, removed at the end.
class OutputFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "montelux_output_XXXXXX").string();
    folder = mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder); }

  static std::string bytes(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static mode_t mode(const fs::path& path) {
    struct stat found {};
    return stat(path.c_str(), &found) == 0 ? found.st_mode & 07777 : 0;
  }
  std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(folder), {}); }
  fs::path folder;
};

// While it lives, files end after so many bytes: as if the disk were full.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t size) : before_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit now{size, limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~SizeLimit() {
    setrlimit(RLIMIT_FSIZE, &limit_);
    signal(SIGXFSZ, before_);
  }

 private:
  rlimit limit_{};
  void (*before_)(int);
};

TEST_F(OutputFile, is_replaced_and_keeps_its_mode) {
  ASSERT_TRUE(write_file(folder / "a", "first"));
  const mode_t mask = umask(0);
  umask(mask);
  EXPECT_EQ(mode(folder / "a"), 0666 & ~mask);
  ASSERT_EQ(chmod((folder / "a").c_str(), 0604), 0);
  ASSERT_TRUE(write_file(folder / "a", "second"));
  EXPECT_EQ(bytes(folder / "a"), "second");
  EXPECT_EQ(mode(folder / "a"), 0604);
  EXPECT_EQ(count(), 1);
}

TEST_F(OutputFile, stays_as_it_was_where_the_disk_is_full) {
  ASSERT_TRUE(write_file(folder / "a", "old"));
  const std::string big(100000, 'x');
  Status written = Done{};
  {
    const SizeLimit limit(5000);
    written = write_file(folder / "a", big);
  }
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error(), "cannot write '" + (folder / "a").string() + "': File too large");
  EXPECT_EQ(bytes(folder / "a"), "old");
  EXPECT_EQ(count(), 1);
}

TEST_F(OutputFile, behind_a_chain_of_links_is_replaced_and_the_links_stay) {
  fs::create_directory(folder / "far");
  fs::create_symlink("far/b", folder / "a");
  fs::create_symlink(folder / "far/c", folder / "far/b");
  for (const char* text : {"new", "newer"}) {
    ASSERT_TRUE(check_output_file(folder / "a"));
    ASSERT_TRUE(write_file(folder / "a", text));
    EXPECT_TRUE(fs::is_symlink(folder / "a"));
    EXPECT_TRUE(fs::is_symlink(folder / "far/b"));
    EXPECT_FALSE(fs::is_symlink(folder / "far/c"));
    EXPECT_EQ(bytes(folder / "far/c"), text);
  }
  fs::create_symlink("loop", folder / "loop");
  EXPECT_FALSE(check_output_file(folder / "loop"));
  EXPECT_FALSE(write_file(folder / "loop", "x"));
}

TEST_F(OutputFile, of_a_device_or_a_descriptor_is_written_to) {
  EXPECT_TRUE(check_output_file("/dev/null"));
  EXPECT_TRUE(write_file("/dev/null", "bytes"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const Status full = write_file("/dev/full", "bytes");
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error(), "cannot write '/dev/full': No space left on device");
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_TRUE(write_file("/dev/fd/" + std::to_string(ends[1]), "bytes"));
  char read_back[8] = {};
  EXPECT_EQ(read(ends[0], read_back, sizeof read_back), 5);
  EXPECT_STREQ(read_back, "bytes");
  close(ends[0]), close(ends[1]);
}

TEST_F(OutputFile, that_cannot_be_written_is_detected_before) {
  EXPECT_FALSE(check_output_file(folder));
  EXPECT_FALSE(check_output_file(folder / "none" / "a"));
  EXPECT_FALSE(check_output_file(folder / std::string(256, 'n')));
  EXPECT_TRUE(check_output_file(folder / std::string(255, 'n')));
  EXPECT_TRUE(write_file(folder / std::string(255, 'n'), "long"));
  EXPECT_TRUE(check_output_folder(folder / "new" / "folder"));
  EXPECT_FALSE(check_output_folder(folder / std::string(255, 'n') / "folder"));
  EXPECT_EQ(count(), 2);
  if (geteuid() == 0) return;  // to whom everything is open
  ASSERT_EQ(chmod((folder / std::string(255, 'n')).c_str(), 0444), 0);
  EXPECT_FALSE(check_output_file(folder / std::string(255, 'n')));
  ASSERT_EQ(chmod((folder / "new").c_str(), 0555), 0);
  EXPECT_FALSE(check_output_file(folder / "new" / "a"));
}

}  // namespace
}  // namespace montelux
