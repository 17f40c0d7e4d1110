!> The state of the points of a new mesh from that of an old one, by the transfer kind of each variable; laws are not used here.
!>
!> - scalar: carried, kept in the range of old values (options%limit), its mean kept on demand (options%conserve);
!> - tensor: carried component by component in the global frame;
!> - fraction: carried, kept between 0 and 1, their sum as it was (transfer_limits), means on demand;
!> - any other kind: the declared initial value. Contact is carried along the contour (transfer_contact), nodal fields by
!>   shape_weights (transfer_nodes).
!>
!> Carried stresses need not satisfy equilibrium, nor the yield condition of the carried history: the first equilibrium on the new
!> mesh, at fixed time and fixed dies, is elastic, and the first step returns what lies outside the yield surface.
module transfer_states
  use errors, only: error_t, exit_input, fail
  use kinds, only: wp
  use state_pieces, only: state_pieces_t
  use state_table, only: gather_states, hand_out_states, list_variables
  use state_variables, only: state_variable_t, transfer_fraction, transfer_scalar, transfer_tensor
  use text, only: to_text
  use transfer_api, only: transfer_options_t, transfer_t
  use transfer_map, only: carry, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  use transfer_registry, only: list_transfers
  use transfer_report, only: transfer_report_t
  use transfer_treatment, only: treat_materials
  implicit none
  private
  public :: carry_states

contains

  !> Give the groups of `new` (connectivity, variables, npoint, material set) their values.
  subroutine carry_states(from, to, old, new, options, report, error)
    type(transfer_mesh_t), intent(in) :: from, to   !! of `old`, with its trees, and of `new`
    type(state_pieces_t), intent(in) :: old
    type(state_pieces_t), intent(inout) :: new
    type(transfer_options_t), intent(in) :: options
    type(transfer_report_t), intent(out) :: report
    type(error_t), allocatable, intent(out) :: error
    type(transfer_map_t) :: map
    type(transfer_t), allocatable :: methods(:)
    type(state_variable_t), allocatable :: variables(:)
    real(wp), allocatable :: before(:, :), after(:, :)

    call list_transfers(methods)
    if (options%method < 0 .or. options%method >= size(methods)) then
      call fail(error, exit_input, 'state transfer: expected a method from 0 to '//to_text(size(methods) - 1)//', found ' &
                //to_text(options%method))
      return
    end if
    call list_variables(old%groups, [character(len=8) :: transfer_scalar, transfer_tensor, transfer_fraction], variables, error)
    if (allocated(error)) return
    associate (method => methods(options%method + 1))
      report%method = method%name
      call method%weights(from, options, to%points, to%point_material, map, error)
      if (allocated(error)) return
      report%lower_degree = count(map%degree < options%degree .and. method%exact_degree > 0)
    end associate
    report%points_outside = count(map%outside > 0)
    if (size(map%outside) > 0) report%farthest = maxval(map%outside)
    allocate (before(sum(variables%ncomp), size(from%volumes)), after(sum(variables%ncomp), size(to%volumes)))
    call gather_states(old%groups, variables, before)
    call carry(map, before, after)
    call treat_materials(from, to, map, variables, options, before, after, report)
    call hand_out_states(old%groups, variables, after, new%groups)
  end subroutine carry_states

end module transfer_states
