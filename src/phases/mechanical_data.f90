!> What a steel lacks for the mechanics of its phases.
module mechanical_data
  use phase_flow, only: has_yield
  use phases_there, only: phases_that_form
  use steels, only: austenite, expansion_none, phase_count, phase_names, plasticity_leblond, plasticity_none, prop_alpha, &
                    prop_consistency, prop_plasticity, prop_poisson, prop_rate, prop_strain, prop_yield, prop_young, steel_t
  use temperature_curves, only: is_given
  use text, only: add_text, string_t
  implicit none
  private
  public :: lacking_mechanical_data, lacking_viscosity

contains

  !> What the phases that may form lack for their flow by the rate, a line each; with `given` those that are there in spite of not
  !> forming.
  pure subroutine lacking_viscosity(steel, problems, given)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(inout) :: problems(:)   !! (nproblem) those found are added
    logical, intent(in), optional :: given(:)                   !! (phase_count)
    logical :: there(phase_count)
    integer :: i

    there = phases_that_form(steel)
    if (present(given)) there = given .and. .not. there
    do i = 1, phase_count
      if (.not. there(i)) cycle
      if (is_given(steel%properties(prop_consistency, i)) .and. is_given(steel%properties(prop_rate, i))) cycle
      call add_text(problems, 'the steel '''//steel%name//''' has no P2 and P3 of '//trim(phase_names(i)))
    end do
  end subroutine lacking_viscosity

  !> What the phases that may form lack for their mechanics, a line each; with `given` those that are there in spite of not
  !> forming: of transformation plasticity they need nothing.
  pure subroutine lacking_mechanical_data(steel, problems, given)
    type(steel_t), intent(in) :: steel
    type(string_t), allocatable, intent(out) :: problems(:)   !! (nproblem)
    logical, intent(in), optional :: given(:)                 !! (phase_count)
    logical :: there(phase_count)
    logical, parameter :: from_austenite(phase_count) = [.false., .true., .true., .true., .true., .false.]
    integer :: i

    allocate (problems(0))
    there = phases_that_form(steel)
    if (present(given)) there = given .and. .not. there
    if (steel%expansion == expansion_none .and. .not. present(given)) &
      call add_text(problems, 'the steel '''//steel%name//''' has no card EXPAND, the form of strains by temperature and phases')
    do i = 1, phase_count
      if (.not. there(i)) cycle
      call ask_for(i, prop_young, 'E', problems)
      call ask_for(i, prop_poisson, 'NU', problems)
      call ask_for(i, prop_alpha, 'ALPHA', problems)
      if (i /= austenite) call ask_for(i, prop_strain, 'DEPS', problems)
      if (has_yield(steel) .neqv. is_given(steel%properties(prop_yield, i))) &
        call add_text(problems, 'the steel '''//steel%name//''' has SY of some phases and none of '// &
                      trim(phase_names(merge(i, austenite, has_yield(steel)))))
      if (present(given)) cycle
      if (.not. from_austenite(i) .or. any(steel%plasticity == [plasticity_none, plasticity_leblond])) cycle
      call ask_for(i, prop_plasticity, 'KTP', problems)
    end do
    if (present(given)) return
    if (steel%plasticity == plasticity_leblond .and. .not. has_yield(steel) .and. &
        any(there .and. from_austenite .and. .not. is_given(steel%properties(prop_plasticity, :)))) &
      call add_text(problems, 'the steel '''//steel%name//''' needs KTP of all phases, or SY, for TRIP LEBLOND')

  contains

    pure subroutine ask_for(phase, property, name, list)
      integer, intent(in) :: phase, property
      character(len=*), intent(in) :: name
      type(string_t), allocatable, intent(inout) :: list(:)   !! (nproblem)

      if (.not. is_given(steel%properties(property, phase))) &
        call add_text(list, 'the steel '''//steel%name//''' has no '//name//' of '//trim(phase_names(phase)))
    end subroutine ask_for

  end subroutine lacking_mechanical_data

end module mechanical_data
