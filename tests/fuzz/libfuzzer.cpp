// The same runs for clang's libFuzzer, which finds its inputs by coverage. MONTELUX_FUZZ_KIND names the kind.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "kinds.h"
#include "temporary_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const montelux::fuzz::Kind* const kind = [] {
    const char* name = std::getenv("MONTELUX_FUZZ_KIND");
    const montelux::fuzz::Kind* named = montelux::fuzz::kind_named(name ? name : "pbrt");
    if (!named) std::fprintf(stderr, "there is no kind \"%s\"\n", name), std::exit(2);
    return named;
  }();
  static const montelux::test::TemporaryFolder folder;
  // What is thrown here ends the process, and libFuzzer keeps the input.
  kind->run(std::string(reinterpret_cast<const char*>(data), size), folder.path());
  return 0;
}
