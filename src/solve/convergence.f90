!> Norms of residuals and corrections, and the round-off of both. All tolerances are without unit.
!>
!> Each quantity of a solve (motion, temperature) has norms of its own: a force is not compared with a heat flow. What is returned
!> is the largest of them. The section of generalised plane strain has its own too: its force is that on the whole section, those
!> on nodes are those on sides of the thickness, and which is the larger depends on the unit of length.
module convergence
  use equations, only: equations_t
  use fields, only: displacement_field, field_t, pilot_field, section_field
  use kinds, only: wp
  implicit none
  private
  public :: relative_residual, relative_motion, forces_of_others, free_force, pilots_in_equilibrium, heat_in_balance, slope_along, &
            weigh_quantities

  !> Motions below this share of the mesh's size are round-off of coordinates; changes of another quantity below this share of its
  !> largest value likewise.
  real(wp), parameter :: least_motion = 1.0e-10_wp
  !> At a limit point a load factor does not change: corrections are compared with this share of its value at least.
  real(wp), parameter :: least_change_of_load = 1.0e-3_wp

  !> Heat is in balance when what is missing in all is below this share of what is taken up, released or comes in where temperatures
  !> are imposed.
  real(wp), parameter :: balance_tolerance = 1.0e-9_wp

  !> A free pilot is in equilibrium when its residual is below this share of the forces that act on it.
  real(wp), parameter :: pilot_tolerance = 1.0e-8_wp

contains

  !> The few unknowns that carry the force of a whole die have a norm of their own.
  pure function pilots_in_equilibrium(equations, fields, external, residual) result(in_equilibrium)
    type(equations_t), intent(in) :: equations
    type(field_t), intent(in) :: fields(:)             !! (nfield)
    real(wp), intent(in) :: external(:), residual(:)   !! (ndof) [residual]
    logical :: in_equilibrium
    integer :: k, c, d

    in_equilibrium = .true.
    do k = 1, size(equations%dofs%fields(pilot_field)%number, 2)
      do c = 1, 3
        d = equations%dofs%fields(pilot_field)%number(c, k)
        if (d == 0) cycle
        if (equations%solves(equations%now)%equation(d) == 0) cycle
        in_equilibrium = in_equilibrium .and. abs(residual(d)) &
                         <= max(pilot_tolerance*max(abs(external(d)), equations%magnitude(d)), &
                                fields(displacement_field)%floor*merge(equations%size, 1.0_wp, equations%dofs%is_angle(d)))
      end do
    end do
  end function pilots_in_equilibrium

  !> The heat that a step would leave out of its books, the sum of the residual heat flows, is small: residuals within their norm
  !> may add up to more, and with the same sign in every step. True where no temperature is solved for.
  pure function heat_in_balance(equations, residual, dt) result(in_balance)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: residual(:)   !! (ndof) [residual]
    real(wp), intent(in) :: dt            !! [time]
    logical :: in_balance
    real(wp) :: missing, passed
    integer :: d, q

    missing = 0
    passed = 0
    do q = 1, size(equations%dofs%quantities)
      if (equations%dofs%quantities(q)%s /= 'temperature' .or. .not. is_solved_for(equations, q)) cycle
      associate (solve => equations%solves(equations%now))
        do d = 1, size(residual)
          if (equations%dofs%quantity(d) /= q .or. .not. solve%is_own(d)) cycle
          if (solve%equation(d) > 0) missing = missing + residual(d)
          if (solve%equation(d) == 0) passed = passed + abs(equations%force(d))
        end do
      end associate
      passed = passed + max(abs(equations%heat_stored), abs(equations%heat_released))/(equations%stage%share*dt)
    end do
    in_balance = abs(missing) <= balance_tolerance*passed
  end function heat_in_balance

  !> Residual of the free unknowns over the largest of external force, reactions and element forces; 0 when it is
  !> round-off. Moments on pilots depend on where the pilot stands: they are no measure of the forces.
  pure function relative_residual(equations, fields, external, residual, du) result(norm)
    type(equations_t), intent(in) :: equations
    type(field_t), intent(in) :: fields(:)             !! (nfield)
    real(wp), intent(in) :: external(:), residual(:)   !! (ndof) [residual]
    real(wp), intent(in) :: du(:)                      !! (ndof) motion of the step [unknown]
    real(wp) :: norm
    integer :: q

    norm = 0
    do q = 1, size(equations%dofs%quantities)
      if (.not. is_solved_for(equations, q)) cycle
      norm = larger(norm, residual_of(q))
      if (is_motion(equations, q)) norm = larger(norm, residual_of_section())
    end do

  contains

    pure function residual_of(q) result(own)
      integer, intent(in) :: q
      real(wp) :: own
      real(wp) :: reference, round_off

      own = free_norm(equations, q, residual, 1/equations%size)
      reference = max(norm_of(equations, q, external), norm_of(equations, q, residual), norm_of(equations, q, equations%magnitude))
      if (.not. is_motion(equations, q)) reference = max(reference, equations%source)
      round_off = floor_of(equations, fields, q)
      if (is_motion(equations, q)) round_off = round_off*max(1.0_wp, norm_of(equations, q, du)/equations%size)
      if (own <= round_off) then
        own = 0
      else if (reference > 0) then
        own = own/reference
      end if
    end function residual_of

    !> Moments count as forces at the distance of the mesh's size, the axial force is the measure of both. Its round-off is that of
    !> the forces on nodes, on an area of the mesh's size instead of one of the thickness.
    pure function residual_of_section() result(own)
      real(wp) :: own
      real(wp) :: reference

      own = section_norm(equations, residual, 1/equations%size, free=.true.)
      if (.not. own > 0) return
      associate (section => fields(section_field)%value(:, 1), number => equations%dofs%fields(section_field)%number(:, 1))
        reference = max(section_norm(equations, external, 1/equations%size, free=.false.), own)
        if (number(1) > 0) reference = max(reference, equations%magnitude(number(1)))
        if (own <= fields(displacement_field)%floor*max(1.0_wp, equations%size/section(1))) then
          own = 0
        else
          own = own/reference
        end if
      end associate
    end function residual_of_section

  end function relative_residual

  !> Correction over the motion of the step, angles of pilots left out.
  pure function relative_motion(equations, fields, correction, du) result(norm)
    type(equations_t), intent(in) :: equations
    type(field_t), intent(in) :: fields(:)         !! (nfield)
    real(wp), intent(in) :: correction(:), du(:)   !! (ndof) [unknown]
    real(wp) :: norm
    real(wp) :: motion, own
    integer :: q

    norm = 0
    do q = 1, size(equations%dofs%quantities)
      if (.not. is_solved_for(equations, q)) cycle
      motion = max(norm_of(equations, q, du), least_change(equations, fields, q))
      norm = larger(norm, share_of(free_norm(equations, q, correction, equations%size), motion))
      if (.not. is_motion(equations, q)) cycle
      own = section_norm(equations, correction, equations%size, free=.true.)
      ! a section is as long as it is thick: motions count over that as those of nodes do over the mesh's size
      if (own > 0) norm = larger(norm, own/max(section_norm(equations, du, equations%size, free=.false.), &
                                               fields(section_field)%value(1, 1)/equations%size*motion))
    end do
  end function relative_motion

  !> A norm over another one above zero, which may be so small that their ratio is none of this kind: the largest there is, then.
  pure function share_of(a, b) result(share)
    real(wp), intent(in) :: a, b
    real(wp) :: share

    share = huge(share)
    if (.not. a/share >= b) share = a/b
  end function share_of

  !> The larger of two norms; NaN counts as the largest.
  pure function larger(a, b) result(c)
    real(wp), intent(in) :: a, b
    real(wp) :: c

    c = a
    if (.not. b <= a) c = b
  end function larger

  !> Weights by which residuals of several quantities are added up in one norm: 1 where there is one.
  subroutine weigh_quantities(equations, external, residual)
    type(equations_t), intent(inout) :: equations
    real(wp), intent(in) :: external(:), residual(:)   !! (ndof) [residual]
    real(wp) :: reference
    integer :: q

    equations%weight = 1
    if (count([(is_solved_for(equations, q), q=1, size(equations%weight))]) < 2) return
    do q = 1, size(equations%weight)
      reference = max(norm_of(equations, q, external), norm_of(equations, q, residual), norm_of(equations, q, equations%magnitude))
      if (reference > 0) equations%weight(q) = 1/reference
    end do
  end subroutine weigh_quantities

  !> Norm of residuals on the free unknowns, those of each quantity by its weight; moments count as forces at the distance of the
  !> mesh's size.
  pure function free_force(equations, v) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: v(:)   !! (ndof) [residual]
    real(wp) :: norm
    real(wp) :: own
    integer :: q, n

    n = 0
    norm = 0
    do q = 1, size(equations%dofs%quantities)
      if (.not. is_solved_for(equations, q)) cycle
      n = n + 1
      own = free_norm(equations, q, v, 1/equations%size)
      if (is_motion(equations, q)) own = hypot(own, section_norm(equations, v, 1/equations%size, free=.true.))
      if (n == 1) then
        norm = equations%weight(q)*own
      else
        norm = hypot(norm, equations%weight(q)*own)
      end if
    end do
  end function free_force

  !> Work of residuals along a correction: of the motion, where the solve has one (the energy that a line search uses).
  pure function slope_along(equations, correction, residual) result(slope)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: correction(:)   !! (ndof) [unknown]
    real(wp), intent(in) :: residual(:)     !! (ndof) [residual]
    real(wp) :: slope
    integer :: q

    if (count([(is_solved_for(equations, q), q=1, size(equations%dofs%quantities))]) < 2) then
      slope = dot_product(correction, residual)
    else
      slope = sum(correction*residual, mask=equations%dofs%quantity == 1)
    end if
  end function slope_along

  !> Forces that a correction of the other quantities takes on the motion, by the matrix at hand; 0 where one is solved for. They
  !> are no part of the work of a correction: with K the matrix of the motion, residual - others = K du, and du K du is the energy
  !> that a line search uses, above 0 unless the motion is past a limit point. du times the residual is not, as where a temperature
  !> alone is out of balance and the motion follows it.
  pure function forces_of_others(equations, correction) result(others)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: correction(:)   !! (ndof) [unknown]
    real(wp) :: others(size(correction))    !! [residual]
    integer :: dof(equations%solves(equations%now)%neq)
    integer :: d, k, q

    others = 0
    if (count([(is_solved_for(equations, q), q=1, size(equations%dofs%quantities))]) < 2) return
    associate (solve => equations%solves(equations%now))
      do d = 1, size(correction)
        if (solve%equation(d) > 0) dof(solve%equation(d)) = d
      end do
      do k = 1, solve%pattern%nnz
        call add(dof(solve%pattern%row(k)), dof(solve%pattern%column(k)))
        if (solve%pattern%symmetric) call add(dof(solve%pattern%column(k)), dof(solve%pattern%row(k)))
      end do
    end associate

  contains

    pure subroutine add(to, from)
      integer, intent(in) :: to, from   !! unknowns of the row and the column of a nonzero

      if (equations%dofs%quantity(to) /= 1 .or. equations%dofs%quantity(from) == 1) return
      others(to) = others(to) + equations%solves(equations%now)%values(k)*correction(from)
    end subroutine add
  end function forces_of_others

  !> A quantity is among those of the solve under way.
  pure function is_solved_for(equations, q) result(yes)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: q
    logical :: yes

    yes = any(equations%solves(equations%now)%is_own .and. equations%dofs%quantity == q)
  end function is_solved_for

  !> Displacements come first among the fields: theirs is the first quantity.
  pure function is_motion(equations, q) result(yes)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: q
    logical :: yes

    yes = equations%dofs%quantities(q)%s == 'motion'
  end function is_motion

  !> Round-off of what acts on the fields of a quantity.
  pure function floor_of(equations, fields, q) result(floor)
    type(equations_t), intent(in) :: equations
    type(field_t), intent(in) :: fields(:)
    integer, intent(in) :: q
    real(wp) :: floor
    integer :: f

    floor = 0
    do f = 1, size(fields)
      if (fields(f)%quantity == equations%dofs%quantities(q)%s) floor = max(floor, fields(f)%floor)
    end do
  end function floor_of

  !> A change that is round-off of the values themselves.
  pure function least_change(equations, fields, q) result(change)
    type(equations_t), intent(in) :: equations
    type(field_t), intent(in) :: fields(:)
    integer, intent(in) :: q
    real(wp) :: change
    integer :: f

    change = tiny(change)
    if (is_motion(equations, q)) then
      change = least_motion*equations%size
      return
    end if
    do f = 1, size(fields)
      if (fields(f)%quantity == equations%dofs%quantities(q)%s .and. size(fields(f)%value) > 0) &
        change = max(change, merge(least_change_of_load, least_motion, fields(f)%quantity == 'load') &
                     *maxval(abs(fields(f)%value)))
    end do
  end function least_change

  !> Euclidean norm over the unknowns of a quantity, without angles and moments, and without the section.
  pure function norm_of(equations, q, v) result(norm)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: q
    real(wp), intent(in) :: v(:)
    real(wp) :: norm

    norm = sqrt(sum(v**2, mask=.not. (equations%dofs%is_angle .or. is_of_section(equations)) .and. equations%dofs%quantity == q))
  end function norm_of

  !> Unknowns of the section (ndof).
  pure function is_of_section(equations) result(yes)
    type(equations_t), intent(in) :: equations
    logical :: yes(equations%dofs%ndof)
    integer :: c

    yes = .false.
    associate (number => equations%dofs%fields(section_field)%number)
      do c = 1, size(number)
        if (number(c, 1) > 0) yes(number(c, 1)) = .true.
      end do
    end associate
  end function is_of_section

  !> Euclidean norm over the unknowns of the section, or its free ones, the slopes of its thickness times `lever`.
  pure function section_norm(equations, v, lever, free) result(norm)
    type(equations_t), intent(in) :: equations
    real(wp), intent(in) :: v(:), lever
    logical, intent(in) :: free
    real(wp) :: norm
    integer :: c, d

    norm = 0
    associate (number => equations%dofs%fields(section_field)%number)
      do c = 1, size(number)
        d = number(c, 1)
        if (d == 0) cycle
        if (free .and. equations%solves(equations%now)%equation(d) == 0) cycle
        norm = norm + merge(v(d), lever*v(d), c == 1)**2
      end do
    end associate
    norm = sqrt(norm)
  end function section_norm

  !> Euclidean norm over the free unknowns of a quantity but for the section, those that are angles times `lever`.
  pure function free_norm(equations, q, v, lever) result(norm)
    type(equations_t), intent(in) :: equations
    integer, intent(in) :: q
    real(wp), intent(in) :: v(:), lever
    real(wp) :: norm
    logical :: apart(size(v))
    integer :: d

    norm = 0
    apart = is_of_section(equations)
    associate (solve => equations%solves(equations%now))
      do d = 1, size(v)
        if (solve%equation(d) > 0 .and. equations%dofs%quantity(d) == q .and. .not. apart(d)) &
          norm = norm + merge(lever*v(d), v(d), equations%dofs%is_angle(d))**2
      end do
    end associate
    norm = sqrt(norm)
  end function free_norm

end module convergence
