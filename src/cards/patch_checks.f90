!> Where patches are eliminated (NORMS PATCH) all that acts on them must be of their elements, and their solver must find entries of
!> the inverse.
module patch_checks
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use fields, only: displacement_field
  use linear_api, only: solver_row_t
  use linear_registry, only: list_solvers
  use scene, only: scene_t
  use scene_draft, only: draft_t, head_location
  use strategy, only: coupling_monolithic, patch_by_matrix
  implicit none
  private
  public :: settle_patches

contains

  !> PATCH in a scene that it is not for; without the word there are none in it, nor where nothing is in contact with a rigid die:
  !> there Newton's method is seldom held up by a few elements.
  subroutine settle_patches(deck, draft, diagnostics)
    type(deck_t), intent(in) :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout) :: diagnostics
    character(len=:), allocatable :: why
    integer :: i

    if (draft%scene%strategy%patch == 0) return
    why = what_prevents(draft%scene)
    if (draft%scene%strategy%patch == patch_by_matrix) then
      if (why /= '' .or. .not. any(draft%scene%groups%die > 0)) draft%scene%strategy%patch = 0
      return
    end if
    if (why == '') return
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword == 'NORMS') call diagnostics%add(head_location(deck%cards(i)), 'NORMS', 'PATCH: '//why)
    end do
  end subroutine settle_patches

  !> Why no patch can be eliminated; '' where it can.
  function what_prevents(scene) result(why)
    type(scene_t), intent(in) :: scene
    character(len=:), allocatable :: why
    type(solver_row_t), allocatable :: rows(:)

    call list_solvers(rows)
    why = ''
    if (.not. scene%fields(displacement_field)%declared) then
      why = 'nothing moves: expected PATCH 0, or a body that moves'
    else if (.not. rows(scene%strategy%linear_solver)%inverts) then
      why = rows(scene%strategy%linear_solver)%name//' finds no entries of the inverse: expected SOLVR MIXED or FRONT, or PATCH 0'
    else if (scene%load_factor%multiplier > 0) then
      why = 'a load that is found (LOADF) acts on all elements at once: expected PATCH 0'
    else if (any(scene%groups%pairs > 0)) then
      why = 'sides that face a die made of sides change their pairs: expected PATCH 0'
    else if (scene%strategy%coupling == coupling_monolithic) then
      why = 'motion and temperature are found together: expected SOLVE ONCE or CONVERGE, or PATCH 0'
    end if
  end function what_prevents

end module patch_checks
