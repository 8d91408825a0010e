// Where an effect can act. An effect has, for each site in its kSites, the member function named
// here; a plant calls those of every active effect where the equations have that place.
//
// | site         | member function                         | meaning |
// |--------------|-----------------------------------------|---------------------------------------|
// | opening      | S opening_m(p, x_m, gain_m_per_V)       | valve opening from the spool position
// | | inertia      | S added_mass_kg(p)                      | mass that moves with the rod | |
// force        | S resisting_N(p, y_m, v_mps)            | a force against extension             |
// | dry_friction | S friction_N(p, memory, DryContact)     | needs the other forces: may hold them
// |
//
// A force effect that is steep in speed may add `S slope_N_s_per_m(p, v_mps)`, dF/dv, from which
// the integrator takes shorter steps. An effect with memory has a struct Memory, owned by the
// plant, and `void accept(p, memory, travel_m, v_mps)`, called once per accepted integration step.
// A new site is a line here, a call in EffectSet and a place in a plant.
#pragma once

namespace plant_sim {

enum class Site { opening, inertia, force, dry_friction };

inline const char* site_name(Site site) {
  switch (site) {
    case Site::opening:
      return "opening";
    case Site::inertia:
      return "inertia";
    case Site::force:
      return "force";
    case Site::dry_friction:
      return "dry_friction";
  }
  return "";
}

/// What a dry friction sees of the moving part at one instant of an integration step.
template <class S>
struct DryContact {
  S v_mps;
  S travel_m;         ///< since the last accepted step
  S drive_N;          ///< sum of all other forces on the moving part, positive extends
  S arrest_kg_per_s;  ///< mass over step: the force per speed that stops it within one step
};

}  // namespace plant_sim
