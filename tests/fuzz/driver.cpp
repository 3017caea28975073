// The fuzzer: damages examples by a seed and runs Montelux on them, many times in one process.
#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "damage.h"
#include "guard.h"
#include "kinds.h"
#include "temporary_folder.h"

namespace montelux::fuzz {
namespace {

namespace fs = std::filesystem;

struct Options {
  double seconds = 60;
  std::uint64_t runs = ~std::uint64_t(0);
  std::uint32_t seed = 1;
  int run_seconds = 10;
  std::string kind, replay, keep = ".", plant;
};

// Faults of the harness, which show that it finds such.
void plant(const std::string& fault, const std::string& input) {
  if (fault.empty() || input.find("Shape") == std::string::npos) return;
  if (fault == "crash") std::raise(SIGABRT);
  if (fault == "exception") throw std::runtime_error("planted");
  volatile bool hang = fault == "hang";
  while (hang) {
  }
}

class Fuzzer {
 public:
  explicit Fuzzer(const Options& options) : options_(options), work_(folder_.path()) {}

  // Whether the run ended well.
  bool run(const Kind& kind, const std::string& input, const std::string& name) {
    const fs::path running = work_ / "running", kept = fs::path(options_.keep) / name;
    save(running, input);
    guard_run(running, kept, options_.run_seconds);
    std::string problem;
    try {
      plant(options_.plant, input);
      kind.run(input, work_);
    } catch (const std::exception& error) {
      problem = error.what();
    } catch (...) {
      problem = "something that is no exception was thrown";
    }
    end_run();
    if (problem.empty()) return true;
    ++findings_;
    // One input for each problem is enough.
    if (problems_.insert(std::string(kind.name) + problem.substr(0, 40)).second) {
      save(kept, input);
      std::fprintf(stderr, "fuzz: FOUND in %s: %s; the input is kept as %s\n", std::string(kind.name).c_str(),
                   problem.c_str(), kept.c_str());
    }
    return false;
  }

  void fuzz(const std::vector<const Kind*>& chosen) {
    std::map<const Kind*, std::vector<std::string>> examples;
    for (const Kind* kind : chosen) {
      examples[kind] = kind->examples(work_);
      for (std::size_t i = 0; i < examples[kind].size(); ++i)
        run(*kind, examples[kind][i], std::string(kind->name) + "-example-" + std::to_string(i));
    }
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [start] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    std::uint64_t number = 0;
    for (; number < options_.runs && elapsed() < options_.seconds; ++number) {
      const Kind& kind = *chosen[number % chosen.size()];
      // A run depends on the seed and its number alone.
      std::seed_seq of_run{options_.seed, std::uint32_t(number), std::uint32_t(number >> 32)};
      test::DamageRandom random(of_run);
      const std::vector<std::string>& seeds = examples[&kind];
      std::string input = seeds[test::below(random, seeds.size())];
      for (std::size_t n = 1 + test::below(random, 6); n > 0; --n) test::damage(input, random, seeds);
      run(kind, input, std::string(kind.name) + "-" + std::to_string(options_.seed) + "-" + std::to_string(number));
    }
    std::printf("fuzz: %llu runs in %.1f s, seed %u, %d findings\n", static_cast<unsigned long long>(number), elapsed(),
                options_.seed, findings_);
  }

  int findings() const { return findings_; }

 private:
  static void save(const fs::path& file, const std::string& bytes) {
    std::ofstream out(file, std::ios::binary);
    out << bytes;
    out.close();
    if (!out) throw std::runtime_error("cannot write " + file.string());
  }

  Options options_;
  test::TemporaryFolder folder_;
  fs::path work_;
  std::set<std::string> problems_;
  int findings_ = 0;
};

std::string names() {
  std::string all;
  for (const Kind& kind : kinds()) all += (all.empty() ? "" : ", ") + std::string(kind.name);
  return all;
}

int fail(const std::string& message) {
  std::fprintf(stderr, "fuzz: %s\n", message.c_str());
  return 2;
}

int replay(Fuzzer& fuzzer, const Options& options) {
  const fs::path file = options.replay;
  const std::string stem = file.filename().string();
  const Kind* kind = kind_named(options.kind.empty() ? stem.substr(0, stem.find('-')) : options.kind);
  if (!kind) return fail("the name of the file does not begin with a kind; state --kind, one of " + names());
  std::ifstream in(file, std::ios::binary);
  if (!in) return fail("cannot read " + file.string());
  const std::string input{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  fs::create_directories(options.keep);
  const bool good = fuzzer.run(*kind, input, stem + ".again");
  std::printf("fuzz: %s\n", good ? "it ends well" : "it does not end well");
  return good ? 0 : 1;
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Damages scenes, meshes, pictures, saved work and options by a seed and runs Montelux on them.", "fuzz");
  app.add_option("--seconds", options.seconds, "how long (default 60)")->check(CLI::NonNegativeNumber);
  app.add_option("--runs", options.runs, "how many runs at most");
  app.add_option("--seed", options.seed, "of all damage (default 1)");
  app.add_option("--run-seconds", options.run_seconds, "processor time that one run may take (default 10)")
      ->check(CLI::Range(1, 3600));
  app.add_option("--kind", options.kind, "only one of " + names());
  app.add_option("--replay", options.replay, "run this kept input once more");
  app.add_option("--keep", options.keep, "folder for the inputs of findings (default: here)");
  app.add_option("--plant", options.plant, "a fault in the harness: crash, hang or exception")
      ->check(CLI::IsMember({"crash", "hang", "exception"}));
  CLI11_PARSE(app, argc, argv);
  std::error_code error;
  fs::create_directories(options.keep, error);
  if (error) return fail("cannot create the folder " + options.keep + ": " + error.message());
  guard_process(std::size_t(4) << 30);
  Fuzzer fuzzer(options);
  if (!options.replay.empty()) return replay(fuzzer, options);
  std::vector<const Kind*> chosen;
  for (const Kind& kind : kinds())
    if (options.kind.empty() || kind.name == options.kind) chosen.push_back(&kind);
  if (chosen.empty()) return fail("unknown kind " + options.kind + "; valid: " + names());
  std::printf("fuzz: seed %u\n", options.seed);
  std::fflush(stdout);
  fuzzer.fuzz(chosen);
  return fuzzer.findings() > 0 ? 1 : 0;
}

}  // namespace
}  // namespace montelux::fuzz

int main(int argc, char** argv) {
  try {
    return montelux::fuzz::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz: %s\n", error.what());
    return 3;
  }
}
