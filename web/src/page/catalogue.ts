// The entries of summary.json; written by `cargo run -p condyle-results --example result_types`.

export interface Numbers {
  cycles: number;
  mass_loss_mg: number;
  volume_loss_mm3: number;
  volume_loss_mesh_mm3: number;
  max_depth_mm: number;
  wear_over_conventional?: number;
  max_penetration_mm?: number;
  wear_at_max_penetration_mm?: number;
  creep_at_max_penetration_mm?: number;
  max_creep_mm?: number;
  creep_volume_mm3?: number;
  max_unloaded_depth_mm?: number;
  million_penetration_mm?: number;
  million_wear_mm?: number;
  million_creep_mm?: number;
  scan_rise_mm_per_million_cycles?: number;
  scan_at_no_cycles_mm?: number;
  peak_pressure_mpa: number;
  peak_pressure_cycle: number;
  first_cycle_peak_pressure_mpa: number;
  last_cycle_peak_pressure_mpa: number;
  pressure_law_peak_error_percent?: number;
  peak_contact_area_mm2: number;
  peak_contact_area_cycle: number;
  first_cycle_contact_area_mm2: number;
  last_cycle_contact_area_mm2: number;
  peak_von_mises_mpa?: number;
  peak_von_mises_depth_mm?: number;
  peak_max_shear_mpa?: number;
  peak_max_shear_depth_mm?: number;
  peak_max_shear_cycle?: number;
  peak_max_shear_percent?: number;
  first_cycle_max_shear_mpa?: number;
  first_cycle_max_shear_depth_mm?: number;
  max_permanent_set_mm?: number;
  first_cycle_permanent_set_mm?: number;
  max_plastic_strain?: number;
  yielded_elements?: number;
  ratcheting_elements?: number;
  backside_lift_mm?: number;
  backside_lifted_percent?: number;
  backside_slip_mm?: number;
  backside_lock_force_n?: number;
  backside_lock_moment_nm?: number;
  ap_range_mm: number;
  ie_range_deg: number;
  medial_load_share: number;
  deepest_from_load_deg: number;
  deepest_around_load_deg: number;
  updates: number;
  increments: number;
  cycles_solved: number;
  cycles_not_repeating: number;
  newton_iterations: number;
  contact_evaluations: number;
  newton_iterations_per_cycle: number;
  contact_evaluations_per_cycle: number;
  step_halvings: number;
  explicit_steps?: number;
  added_inertia?: number;
  hexahedra: number;
  articulating_nodes: number;
  worst_quality: number;
  wall_s: number;
}

export interface Headline {
  key: keyof Numbers;
  label: string;
  unit: string;
  isShare: boolean;
}

export const HEADLINES: Headline[] = [
  { key: "mass_loss_mg", label: "mass loss", unit: "mg", isShare: false },
  { key: "max_depth_mm", label: "deepest wear", unit: "mm", isShare: false },
  { key: "peak_pressure_mpa", label: "peak pressure", unit: "MPa", isShare: false },
  { key: "peak_contact_area_mm2", label: "largest contact area", unit: "mm2", isShare: false },
  { key: "ap_range_mm", label: "AP range, first cycle", unit: "mm", isShare: false },
  { key: "ie_range_deg", label: "IE range, first cycle", unit: "degrees", isShare: false },
  { key: "medial_load_share", label: "medial load share", unit: "%", isShare: true },
];
