#include "workbench/reproduce/experiment.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>

namespace workbench::reproduce {
namespace {

constexpr Experiment kExperiments[] = {
    {"Printed parameters (Table 5.1)", printed_parameters},
    {"Model structures: cost E over the fifth period (Table 5.2)", structure_costs},
    {"Batch against recursive least squares, ARX111, 60 s (Table 5.3)", batch_against_recursive},
    {"Supply pressure and b1, ARX111 (section 5.3.1)", pressure_sensitivity},
    {"Damping and b1, ARX111 (section 5.3.2)", damping_sensitivity},
    {"Case I: supply pressure 1000, 1250, 1000, 750 psi at 0, 15, 30, 45 s", case_one},
    {"Case II: damping 1000, 1250, 1000, 750 N s/m at 0, 15, 30, 45 s", case_two},
    {"Case III: either may fail", isolation},
    {"Delay: whole periods against a sliding window, real instruments", detection_delay},
    {"The stand at 2,000 psi, ARX211 (chapter 6)", rig_experiment},
    {"The stand with slave actuators and needle valve (chapter 6)", needle_valve},
};

}  // namespace

std::span<const Experiment> experiments() { return kExperiments; }

std::vector<ReproducedSection> run_all(std::span<const Experiment> which, unsigned threads) {
  std::vector<ReproducedSection> sections(which.size());
  std::atomic<std::size_t> next{0};
  std::size_t done = 0;
  std::exception_ptr failure;
  std::mutex mutex;  // guards done, failure and standard error
  const auto work = [&] {
    for (std::size_t i = next++; i < which.size(); i = next++) {
      try {
        sections[i] = {std::string(which[i].title), which[i].run()};
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      std::cerr << "reproduce: " << ++done << " of " << which.size() << ": " << which[i].title
                << '\n';
    }
  };
  {
    std::vector<std::jthread> pool;
    const auto count = std::min<std::size_t>(threads, which.size());
    for (std::size_t i = 1; i < count; ++i) pool.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  return sections;
}

}  // namespace workbench::reproduce
