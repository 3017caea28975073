#include "image/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <optional>
#include <random>
#include <system_error>
#include <utility>

namespace montelux {
namespace {

namespace fs = std::filesystem;

Failure error_text(int error) { return Failure{std::generic_category().message(error)}; }

// A descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  int number() const { return number_; }

 private:
  int number_;
};

// In two parts.
struct Bytes {
  std::string_view first, second;
};

Status write_all(int file, std::string_view bytes) {
  constexpr std::size_t piece = std::size_t(1) << 30;
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), std::min(bytes.size(), piece));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return error_text(errno);
    bytes.remove_prefix(std::size_t(written));
  }
  return Done{};
}

Status write_all(int file, const Bytes& bytes) {
  const Status first = write_all(file, bytes.first);
  return first ? write_all(file, bytes.second) : first;
}

// Some file systems do not support this, which is no error.
Status put_on_disk(int file) {
  if (fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) return Done{};
  return error_text(errno);
}

// The destination of the bytes.
struct Target {
  fs::path file;                     // with links followed
  std::optional<int> descriptor;     // of this process: /dev/stdout
  std::optional<struct stat> there;  // what exists already
  bool is_stream() const { return descriptor || (there && !S_ISREG(there->st_mode)); }
};

// The number of a descriptor from its name in the folder of this process's descriptors, /dev/fd.
std::optional<int> descriptor_named(const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::canonical(file.has_parent_path() ? file.parent_path() : ".", error);
  if (error || folder != "/proc/" + std::to_string(getpid()) + "/fd") return std::nullopt;
  const std::string name = file.filename().string();
  int number = 0;
  const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (problem != std::errc{} || end != name.data() + name.size()) return std::nullopt;
  return number;
}

Result<Target> target_of(const fs::path& path) {
  constexpr int max_links = 40;
  Target target{path, std::nullopt, std::nullopt};
  struct stat found {};
  for (int links = 0; lstat(target.file.c_str(), &found) == 0; ++links) {
    if (S_ISDIR(found.st_mode)) return Failure{"it is a folder"};
    if (!S_ISLNK(found.st_mode)) {
      target.there = found;
      return target;
    }
    target.descriptor = descriptor_named(target.file);
    if (target.descriptor) return target;
    std::error_code error;
    const fs::path next = fs::read_symlink(target.file, error);
    if (error || links == max_links) return error_text(error ? error.value() : ELOOP);
    target.file = target.file.parent_path() / next;  // an absolute path stands for itself
  }
  if (errno != ENOENT) return error_text(errno);
  return target;
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : "."; }

// A new file next to another one. It is removed at the end unless it has replaced the other one.
class Temporary {
 public:
  static Result<Temporary> beside(const fs::path& file) {
    std::random_device random;
    for (int attempt = 0;; ++attempt) {
      std::string name(temporary_prefix);
      for (int i = 0; i < 8; ++i) name += "0123456789abcdefghijklmnopqrstuv"[random() % 32];
      const fs::path path = folder_of(file) / name;
      const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor >= 0) return Temporary(path, Descriptor(descriptor));
      if (errno != EEXIST || attempt == 100) return error_text(errno);
    }
  }
  ~Temporary() {
    if (!path_.empty()) unlink(path_.c_str());
  }
  Temporary(Temporary&& other) noexcept
      : path_(std::exchange(other.path_, {})), descriptor_(std::move(other.descriptor_)) {}

  int descriptor() const { return descriptor_.number(); }

  // Copies mode, owner and group of the file that this one is to replace. If the group cannot be kept, its rights are
  // not given to another group.
  Status resemble(const struct stat& old) {
    struct stat now {};
    if (fstat(descriptor(), &now) != 0) return error_text(errno);
    mode_t mode = old.st_mode & 0777;
    const bool same = now.st_uid == old.st_uid && now.st_gid == old.st_gid;
    if (!same && fchown(descriptor(), old.st_uid, old.st_gid) != 0 && now.st_gid != old.st_gid &&
        fchown(descriptor(), uid_t(-1), old.st_gid) != 0)
      mode = (mode & ~mode_t(070)) | (mode & 07) << 3;
    if (fchmod(descriptor(), mode) != 0) return error_text(errno);
    return Done{};
  }

  Status rename_to(const fs::path& file) {
    if (std::rename(path_.c_str(), file.c_str()) != 0) return error_text(errno);
    path_.clear();
    return Done{};
  }

 private:
  Temporary(fs::path path, Descriptor descriptor) : path_(std::move(path)), descriptor_(std::move(descriptor)) {}
  fs::path path_;
  Descriptor descriptor_;
};

Status write_stream(const Target& target, const Bytes& bytes) {
  const Descriptor stream(target.descriptor ? dup(*target.descriptor)
                                            : open(target.file.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
  if (stream.number() < 0) return error_text(errno);
  return write_all(stream.number(), bytes);
}

Status replace(const Target& target, const Bytes& bytes) {
  Result<Temporary> temporary = Temporary::beside(target.file);
  if (!temporary) return temporary.failure();
  if (Status written = write_all(temporary->descriptor(), bytes); !written) return written;
  if (target.there)
    if (Status alike = temporary->resemble(*target.there); !alike) return alike;
  if (Status kept = put_on_disk(temporary->descriptor()); !kept) return kept;
  if (Status renamed = temporary->rename_to(target.file); !renamed) return renamed;
  // The new name must be on the disk, too. A folder that cannot be read can still be written to.
  const Descriptor folder(open(folder_of(target.file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return folder.number() < 0 ? Status(Done{}) : put_on_disk(folder.number());
}

// A protected file is not replaced, even if the rights of the folder allow it.
Status check_rights(const Target& target) {
  if (!target.there || access(target.file.c_str(), W_OK) == 0) return Done{};
  return error_text(errno);
}

Status write_to(const Target& target, const Bytes& bytes) {
  if (target.is_stream()) return write_stream(target, bytes);
  if (Status allowed = check_rights(target); !allowed) return allowed;
  return replace(target, bytes);
}

Status check(const Target& target) {
  if (target.descriptor) return Done{};
  if (Status allowed = check_rights(target); !allowed || target.is_stream()) return allowed;
  std::error_code error;
  if (!fs::exists(folder_of(target.file), error)) return Failure{"there is no such folder"};
  Result<Temporary> temporary = Temporary::beside(target.file);
  return temporary ? Status(Done{}) : temporary.failure();
}

Status named(const fs::path& path, const Status& status) {
  if (status) return status;
  return Failure{"cannot write '" + path.string() + "': " + status.error()};
}

}  // namespace

Status write_file(const fs::path& path, std::string_view bytes) { return write_file(path, bytes, {}); }

Status write_file(const fs::path& path, std::string_view first, std::string_view second) {
  const Result<Target> target = target_of(path);
  return named(path, target ? write_to(*target, {first, second}) : Status(target.failure()));
}

Status check_output_file(const fs::path& path) {
  const Result<Target> target = target_of(path);
  return named(path, target ? check(*target) : Status(target.failure()));
}

Status check_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Failure{"cannot create the folder '" + folder.string() + "': " + error.message()};
  const Result<Temporary> temporary = Temporary::beside(folder / "file");
  return temporary ? Status(Done{})
                   : Failure{"cannot write to the folder '" + folder.string() + "': " + temporary.error()};
}

}  // namespace montelux
