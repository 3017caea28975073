// A library that is loaded before the program under test (LD_PRELOAD). It writes each call that fsync and rename get to
// the file DISK_WATCH_LOG, and lets each fsync take DISK_WATCH_DELAY milliseconds longer, as a slow disk would.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

// In one write: other processes append to the same file.
void log_line(const std::string& line) {
  const char* file = std::getenv("DISK_WATCH_LOG");
  if (!file) return;
  const int log = open(file, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (log < 0) return;
  [[maybe_unused]] const ssize_t written = write(log, line.data(), line.size());
  close(log);
}

std::string name_of(int file) {
  char name[4096];
  const ssize_t length = readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), name, sizeof name);
  return length < 0 ? "?" : std::string(name, std::size_t(length));
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" int fsync(int file) {
  log_line("fsync " + name_of(file) + "\n");
  if (const char* delay = std::getenv("DISK_WATCH_DELAY")) {
    const useconds_t step = 1000;
    for (int left = std::atoi(delay); left > 0; --left) usleep(step);
  }
  return next<int(int)>("fsync")(file);
}

extern "C" int rename(const char* from, const char* to) {
  log_line("rename " + std::string(from) + " " + to + "\n");
  return next<int(const char*, const char*)>("rename")(from, to);
}
