//! The table of mutations, each with its verdict.

use crate::dice::Dice;
use crate::{arrays, harmless, shape, stack};
use serde_json::Value;

/// What the check has to say of a mutated plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// No rule is broken.
    Valid,
    /// A rule is broken.
    Refused,
    /// Either, depending on what was hit.
    Open,
}

/// A kind of mutation.
pub(crate) struct Kind {
    pub(crate) name: &'static str,
    pub(crate) verdict: Verdict,
    /// Changes the file; false where this plan has nothing of that kind to change, or nothing was changed.
    pub(crate) change: fn(&mut Value, &mut Dice) -> bool,
}

macro_rules! kinds {
    ($($verdict:ident: $($module:ident { $($name:ident)* })*;)*) => {
        /// All kinds.
        pub(crate) const KINDS: &[Kind] = &[
            $($($(Kind { name: stringify!($name), verdict: Verdict::$verdict, change: $module::$name },)*)*)*
        ];
    };
}

kinds! {
    Refused:
        arrays {
            key_gone
            key_of_another_type
            zygote_key_of_another_type
            entry_gone
            entry_twice
            entry_of_another_type
            entries_exchanged
            number_off
            number_out_of_range
            angle_off_by_a_hair
            head_with_another_value
            root_out_of_range
            thickness_of_nothing
            thickness_without_its_ratio
            ratio_off
            frames_that_are_none
            inherited_key_overridden
            order_of_layers_wrong
            order_over_two_layers
        }
        shape {
            target_corner_moved
            zygote_corner_moved
            corners_far_away
            target_off_the_lattice
            target_of_another_lattice
            target_inside_out
            zygote_inside_out
            zygote_lifted
            zygote_beside_its_cells
            face_turned_over
            all_faces_and_edges_turned_over
            face_crossed
            edge_turned_round
            edge_across_its_panel
            cut_edge_twice
            vertex_shared_without_a_hinge
            vertex_gone
            vertex_split
            target_angle_with_its_letter
            zygote_angle_with_its_letter
            another_letter
            two_panels_on_one_square
        }
        stack {
            panels_exchanged_in_the_piles
            panel_twice_in_a_pile
            panel_in_two_piles
            panel_moved_to_another_pile
            pile_run_round
            pile_upside_down
            pile_added_that_is_empty
            two_piles_joined_into_one
            two_piles_on_one_cell
            two_piles_with_exchanged_cells
            cell_apart
            cell_of_another_type
            hinge_on_another_side
            hinge_opening_otherwise
            hinge_of_another_kind
            hinge_between_other_panels
            hinge_entry_lacking_a_key
            hinge_missing
            hinge_added
            hinge_in_place_of_another
            hinge_that_closes_a_loop
            fold_with_its_upper_panel_first
            bridge_at_unequal_heights
        };
    Valid:
        arrays { orders_in_another_order }
        stack { bridge_from_its_other_end }
        harmless {
            face_from_another_corner
            vertices_renumbered
            panels_renumbered
            hinges_in_another_order
            cut_edges_in_another_order
            piles_in_another_order
            whole_numbers_written_with_a_point
            keys_of_others_added
            frame_of_others_added
            another_root
            another_panel_length
            ratio_off_by_rounding
            target_elsewhere
            zygote_elsewhere
            zygote_turned
        };
    Open:
        arrays { anything_anywhere };
}
