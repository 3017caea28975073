#include "image/replace_file.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>

namespace montelux {
namespace {

Status write_guarded(const std::function<Status(const std::string&)>& write, const std::string& temporary) {
  try {
    return write(temporary);
  } catch (const std::exception& e) {
    return Failure{e.what()};
  } catch (...) {
    return Failure{"unknown error"};
  }
}

}  // namespace

Status replace_file(const std::filesystem::path& path, const std::function<Status(const std::string&)>& write) {
  std::string prefix = "cannot write '" + path.string() + "': ";
  std::string extension = path.extension().string();
  std::filesystem::path hidden = path.parent_path() / ".";
  hidden += path.stem();
  hidden += ".XXXXXX";
  hidden += extension;
  std::string temporary = hidden.string();
  int file = mkstemps(temporary.data(), int(extension.size()));
  if (file < 0) return Failure{prefix + std::strerror(errno)};
  // A temporary is private at first; the result is to be readable as any other file.
  bool readable = fchmod(file, S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH) == 0;
  close(file);

  Status written = readable ? write_guarded(write, temporary) : Status(Failure{std::strerror(errno)});
  if (written && std::rename(temporary.c_str(), path.c_str()) == 0) return Done{};
  std::string reason = written ? std::strerror(errno) : written.error();
  unlink(temporary.c_str());
  return Failure{prefix + reason};
}

}  // namespace montelux
