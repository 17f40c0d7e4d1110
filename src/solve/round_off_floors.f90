!> How small the residual of a field can become: round-off of its values through the matrices of the bodies.
module round_off_floors
  use elem_api, only: first_unknown
  use equations, only: equations_t
  use fields, only: displacement_field, field_t, on_nodes
  use kinds, only: eps, wp
  use scene, only: role_body, role_second, scene_t
  implicit none
  private
  public :: round_off_motion, set_floors

  !> Motions below this share of the mesh's size are round-off of coordinates: some eps.
  real(wp), parameter :: round_off_motion = 16*eps

contains

  !> Size of round-off in what acts on the own fields: what a change of round-off makes through the diagonals of the matrices of
  !> the bodies, of temperatures those of what passes their sides too. For motions once for a mesh; others have values, and
  !> matrices with the length of the step, that change.
  pure subroutine set_floors(scene, equations, fields)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    type(field_t), intent(inout) :: fields(:)   !! (nfield)
    integer :: f

    do f = 1, size(fields)
      if (.not. (fields(f)%declared .and. equations%solves(equations%now)%own(f))) cycle
      if (fields(f)%name == 'load_factor') fields(f)%floor = round_off_motion*equations%size*sqrt(sum_of_rows(scene, equations, f))
      if (fields(f)%place /= on_nodes) cycle
      if (f == displacement_field) then
        if (fields(f)%floor > 0) cycle
        fields(f)%floor = round_off_motion*equations%size*sqrt(sum_of_diagonals(scene, equations, f))
      else
        fields(f)%floor = round_off_motion*maxval(abs(fields(f)%value))*sqrt(sum_of_diagonals(scene, equations, f))
      end if
    end do
  end subroutine set_floors

  !> Squares of the rows of a field that has one unknown in all, along the unknowns of other fields.
  pure function sum_of_rows(scene, equations, field) result(sum)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: field
    real(wp) :: sum
    integer :: g, e, i, j, n, m

    sum = 0
    do g = 1, size(scene%groups)
      i = first_unknown(equations%dofs%groups(g)%layout, field)
      if (i == 0) cycle
      n = equations%dofs%groups(g)%layout%ndof
      do e = 1, size(equations%dofs%groups(g)%dof, 2)
        m = equations%solves(1)%pattern%matrix_start(g) + (e - 1)*n*n
        do j = 1, n
          if (j /= i) sum = sum + equations%buffers%matrix(m + (j - 1)*n + i)**2
        end do
      end do
    end do
  end function sum_of_rows

  !> Squares of the diagonals of the matrices of all bodies, and of loads where they are no forces, of the unknowns of one field.
  pure function sum_of_diagonals(scene, equations, field) result(sum)
    type(scene_t), intent(in) :: scene
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: field
    real(wp) :: sum
    integer :: g, e, u, i, ndof, ncomp, m

    sum = 0
    ncomp = size(equations%dofs%fields(field)%number, 1)
    do g = 1, size(scene%groups)
      if (.not. equations%solves(equations%now)%active(g)) cycle
      if (.not. (any(scene%groups(g)%role == [role_body, role_second]) .or. field /= displacement_field)) cycle
      associate (layout => equations%dofs%groups(g)%layout)
        ndof = layout%ndof
        do e = 1, size(equations%dofs%groups(g)%dof, 2)
          m = equations%solves(1)%pattern%matrix_start(g) + (e - 1)*ndof*ndof
          do u = 1, layout%nfield
            if (layout%field(u) /= field) cycle
            ! the components of a field stand one behind the other
            do i = layout%first(1, u), layout%first(1, u) + layout%count(u)*ncomp - 1
              sum = sum + equations%buffers%matrix(m + (i - 1)*ndof + i)**2
            end do
          end do
        end do
      end associate
    end do
  end function sum_of_diagonals

end module round_off_floors
