!> TRACT: a traction that keeps its direction, as nodal forces on the first geometry of the sides.
module cards_tractions
  use card_places, only: numbers_after_name, read_sides
  use deck_cursor, only: cursor_t
  use deck_reader, only: deck_t
  use diagnostics, only: diagnostics_t
  use kinds, only: wp
  use loads, only: nodal_force_t
  use quadrature, only: gauss_line
  use scene_draft, only: close_card, draft_t, words_of
  use sections, only: thickness_at
  use shape_functions, only: line3
  use text, only: string_t
  use vectors, only: length_of
  implicit none
  private
  public :: read_tractions

  !> Gauss points of a side: exact for straight sides, axisymmetric ones included.
  integer, parameter :: rule = 3

contains

  !> All TRACT cards: `place X|Y amplitude lic`.
  subroutine read_tractions(deck, draft, diagnostics)
    type(deck_t), intent(inout), target :: deck
    type(draft_t), intent(inout) :: draft
    type(diagnostics_t), intent(inout), target :: diagnostics
    type(cursor_t) :: cursor
    type(string_t), allocatable :: directions(:)
    character(len=:), allocatable :: label
    integer, allocatable :: sides(:, :)
    real(wp) :: amplitude
    integer :: i, k, component

    call words_of('X Y', directions)
    do i = 1, size(deck%cards)
      if (deck%cards(i)%keyword /= 'TRACT') cycle
      call cursor%open(deck%cards(i), diagnostics)
      call read_sides(cursor, draft, numbers_after_name(deck%cards(i)), label, sides)
      call cursor%name('a direction', directions, component)
      call cursor%real('the amplitude of the traction', amplitude, unit='stress')
      call draft%multipliers%find(cursor, 'the name of a LIC', k)
      call close_card(draft, cursor, deck%cards(i))
      if (cursor%failed() .or. .not. draft%mesh_sound) cycle
      call add_forces(draft, sides, component, amplitude, draft%multipliers%item(k))
    end do
  end subroutine read_tractions

  !> Forces of the shape functions times the traction, per radian when axisymmetric.
  subroutine add_forces(draft, sides, component, amplitude, multiplier)
    type(draft_t), intent(inout) :: draft
    integer, intent(in) :: sides(:, :), component, multiplier
    real(wp), intent(in) :: amplitude
    type(nodal_force_t) :: forces(3*size(sides, 2))
    real(wp), allocatable :: xi(:), weight(:)
    real(wp) :: phi(3), dphi(3), x(2, 3), share(3), length
    integer :: s, p, k

    call gauss_line(rule, xi, weight)
    do s = 1, size(sides, 2)
      x = draft%scene%mesh%coordinates(:, sides(:, s))
      share = 0
      do p = 1, size(xi)
        call line3(xi(p), phi, dphi)
        length = length_of(matmul(x, dphi))*weight(p)*thickness_at(draft%scene%section, matmul(x, phi))
        share = share + phi*length
      end do
      do k = 1, 3
        forces(3*s - 3 + k) = nodal_force_t(sides(k, s), component, amplitude*share(k), multiplier)
      end do
    end do
    draft%scene%forces = [draft%scene%forces, forces]
  end subroutine add_forces

end module cards_tractions
