#include "tests/truth/conditions.h"

namespace truth {

const std::vector<Condition>& conditions() {
  static const std::vector<Condition> table{
      {"1kHz", {}, [](Case& of) { of.sample_s = 0.001; }},
      {"100Hz", {}, [](Case& of) { of.sample_s = 0.01; }},
      {"20Hz",
       {},
       [](Case& of) {
         of.sample_s = 0.05;
         of.kp_V_per_m = 60.0;
       }},
      {"100Hz_log", {}, [](Case& of) { of.log_every = 2; }},
      {"20Hz_log",
       {},
       [](Case& of) {
         of.log_every = 10;
         of.log_mean = true;
       }},
      {"coarse_sensor",
       {},
       [](Case& of) {
         of.encoder_m = 1e-4;
         of.noise_m = 2e-5;
       }},
      {"8s", {}, [](Case& of) { of.length_s = 8.0; }},
      {"pi", {}, [](Case& of) { of.ki_V_per_m_s = 150.0; }},
      {"open_loop",
       {},
       [](Case& of) {
         of.kp_V_per_m = 0.0;
         of.feed_V_s_per_m = 20.0;  // a volt makes about 50 mm/s
       }},
      {"small_motion", {}, [](Case& of) { of.amplitude_ratio = 0.1; }},
      {"sine", {"sine"}, [](Case&) {}},
  };
  return table;
}

const Condition& repeating() {
  static const Condition condition{"repeated", {}, [](Case& of) { of.period_s = 5.0; }};
  return condition;
}

}  // namespace truth
