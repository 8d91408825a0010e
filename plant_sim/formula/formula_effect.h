// A user's own effect as a model file declares it: where it acts, its formula, its parameters with
// their ranges. Whether it acts, and with which values, stands in [effects.NAME] as for an effect
// of the library; declared only, it is a candidate. TOML:
//
//   [formula_effects.cubic_drag]
//   site = "force"
//   formula = "c_N_s3_per_m3 * v_mps^3"
//   what = "drag of the seals"
//   [formula_effects.cubic_drag.parameters.c_N_s3_per_m3]
//   what = "force per speed cubed"
//   min = 0.0
//   max = 1e7
//   typical = 2.5e5
//   neutral = 0.0                # with every parameter neutral the effect has no influence
//
//   [effects.cubic_drag]         # presence adds it
//   c_N_s3_per_m3 = 1.2e5
//
// By site, the formula gives, from variables:
//   command   the command to the valve, V              u_V
//   opening   the valve opening from spool position    x_m (of velocity_servo: speed, m/s), y_m
//   flow      the flow of one orifice, m3/s            q_m3ps
//   leakage   what leaks from chamber i to o, m3/s     in_Pa, out_Pa
//   force     a force against extension, N             y_m, v_mps
//   sensor    what the position sensor shows, m        y_m
// It acts after the library's effects of its site, in the order of declaration. It has no memory.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "plant_sim/effects/site.h"

namespace config::schema {
class Visitor;
}

namespace plant_sim::formula {

struct FormulaEffect {
  struct Parameter {
    std::string name;
    std::string what;
    double min = 0.0;
    double max = 0.0;
    double typical = 0.0;
    double neutral = 0.0;

    void visit(config::schema::Visitor& v);
  };

  std::string name;
  std::string site = "force";
  std::string formula;
  std::string what;
  std::vector<Parameter> parameters;

  void visit(config::schema::Visitor& v);
};

/// A site that accepts a formula.
struct FormulaSite {
  effects::Site site;
  const char* result;                    ///< result of the formula, as printed in equations
  std::array<const char*, 2> variables;  ///< "" is none
  bool chained;  ///< without influence it returns its first variable; else 0, and it is added
  double guard;  ///< numerical bound of the result, far beyond anything real
};

inline constexpr std::array kFormulaSites = {
    FormulaSite{effects::Site::command, "u_out", {"u_V", ""}, true, 1e4},
    FormulaSite{effects::Site::opening, "opening", {"x_m", "y_m"}, true, 1e6},
    FormulaSite{effects::Site::flow, "Q", {"q_m3ps", ""}, true, 1e3},
    FormulaSite{effects::Site::leakage, "Q", {"in_Pa", "out_Pa"}, false, 1e3},
    FormulaSite{effects::Site::force, "F", {"y_m", "v_mps"}, false, 1e9},
    FormulaSite{effects::Site::sensor, "reading", {"y_m", ""}, true, 1e9},
};

/// Null for a site that accepts no formula.
[[nodiscard]] const FormulaSite* find_formula_site(std::string_view name);

}  // namespace plant_sim::formula
