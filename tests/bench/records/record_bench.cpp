// Reading a text of 100 MB: time and memory, beside counting its lines and parsing its numbers with
// std::from_chars alone. Exit code 1 below half that speed or above twice the numbers' memory.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "config/record/record.h"

namespace {

constexpr std::size_t kBytes = 100'000'000;
constexpr double kLeastSpeed = 0.5;
constexpr double kMostMemory = 2.0;

void write_text(const std::filesystem::path& file, bool european) {
  std::ofstream out(file, std::ios::binary);
  out << (european ? "Time [s];Command [V];Position [m]\n" : "t_s,u_V,y_m\n");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u_V(-10.0, 10.0);
  std::uniform_real_distribution<double> y_m(0.0, 0.5);
  char line[64];
  std::size_t bytes = 0;
  for (std::size_t k = 0; bytes < kBytes; ++k) {
    int size = std::snprintf(line, sizeof line, "%.4f,%.6f,%.8f\n", 5e-4 * static_cast<double>(k),
                             u_V(random), y_m(random));
    if (european) {
      std::replace(line, line + size, ',', ';');
      std::replace(line, line + size, '.', ',');
    }
    out.write(line, size);
    bytes += static_cast<std::size_t>(size);
  }
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The least that a reader does: the file in memory, its lines counted, its numbers parsed.
double bare_s(const std::filesystem::path& file) {
  const auto begin = std::chrono::steady_clock::now();
  std::ifstream in(file, std::ios::binary);
  std::string text(std::filesystem::file_size(file), '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  std::vector<double> columns[3];
  for (auto& column : columns) column.reserve(lines);
  const char* at = text.data() + text.find('\n') + 1;
  const char* const end = text.data() + text.size();
  while (at < end) {
    for (auto& column : columns) {
      double value = 0.0;
      at = std::from_chars(at, end, value).ptr + 1;
      column.push_back(value);
    }
  }
  return seconds_since(begin);
}

double largest_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

int main() {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("record_bench_" + std::to_string(getpid()) + ".csv");
  bool good = true;
  for (const bool european : {false, true}) {
    write_text(file, european);
    // The reader first: the largest memory of the process is then the reader's.
    double best_s = 1e9;
    double numbers_bytes = 0.0;
    for (int run = 0; run < 3; ++run) {
      const auto begin = std::chrono::steady_clock::now();
      const config::record::Record record = config::record::read_record(file);
      best_s = std::min(best_s, seconds_since(begin));
      numbers_bytes = 3.0 * sizeof(double) * static_cast<double>(record.size());
    }
    const double memory = largest_bytes() / numbers_bytes;
    if (european) {
      std::printf("100 MB with semicolons and decimal commas: %.2f s, %.0f MB/s\n", best_s,
                  1e-6 * static_cast<double>(std::filesystem::file_size(file)) / best_s);
      continue;
    }
    double peer_s = 1e9;
    for (int run = 0; run < 3; ++run) peer_s = std::min(peer_s, bare_s(file));
    std::printf(
        "100 MB of CSV: %.2f s; lines counted and std::from_chars alone %.2f s: %.2f of its "
        "speed; memory %.2f x the numbers\n",
        best_s, peer_s, peer_s / best_s, memory);
    good = peer_s / best_s >= kLeastSpeed && memory <= kMostMemory;
  }
  std::filesystem::remove(file);
  return good ? 0 : 1;
}
