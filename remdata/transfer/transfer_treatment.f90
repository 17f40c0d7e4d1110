!> Treatment of values after their transfer: ranges, sums of fractions, means, and the report of the changes.
module transfer_treatment
  use kinds, only: wp
  use state_variables, only: component_names, state_variable_t, transfer_fraction, transfer_scalar
  use text, only: string_t
  use transfer_api, only: limit_none, limit_sources, transfer_options_t
  use transfer_balance, only: integral, keep_mean, keep_mean_fractions
  use transfer_limits, only: clip, fractions_rule, keep_fractions, sum_is_one
  use transfer_map, only: range_of_sources, transfer_map_t
  use transfer_mesh, only: transfer_mesh_t
  use transfer_report, only: carried_quantity_t, transfer_report_t
  implicit none
  private
  public :: treat_materials

contains

  !> Ranges, fractions and means, material by material.
  subroutine treat_materials(from, to, map, variables, options, before, after, report)
    type(transfer_mesh_t), intent(in) :: from, to
    type(transfer_map_t), intent(in) :: map
    type(state_variable_t), intent(in) :: variables(:)   !! (nvariable)
    type(transfer_options_t), intent(in) :: options
    real(wp), intent(in) :: before(:, :)     !! (component, npoint) of the old mesh [unit of each component]
    real(wp), intent(inout) :: after(:, :)   !! (component, npoint) of the new mesh [unit of each component]
    type(transfer_report_t), intent(inout) :: report
    real(wp) :: lower(size(after, 2), size(after, 1)), upper(size(after, 2), size(after, 1))
    integer :: m, i, k, n

    n = max(from%nmaterial, to%nmaterial)
    allocate (report%volume_before(n), report%volume_after(n), source=0.0_wp)
    allocate (report%rows(0))
    lower = -huge(1.0_wp)
    upper = huge(1.0_wp)
    if (options%limit == limit_sources) then
      do k = 1, size(before, 1)
        call range_of_sources(map, before(k, :), lower(:, k), upper(:, k))
      end do
    end if
    do m = 1, n
      report%volume_before(m) = sum(from%volumes, mask=from%point_material == m)
      report%volume_after(m) = sum(to%volumes, mask=to%point_material == m)
      if (all(to%point_material /= m)) cycle
      call treat_material(m, from, to, pack([(i, i=1, size(from%volumes))], from%point_material == m), &
                          pack([(i, i=1, size(to%volumes))], to%point_material == m), variables, options, &
                          lower, upper, before, after, report)
    end do
  end subroutine treat_materials

  subroutine treat_material(m, from, to, old_points, new_points, variables, options, lower, upper, before, after, report)
    integer, intent(in) :: m
    type(transfer_mesh_t), intent(in) :: from, to
    integer, intent(in) :: old_points(:), new_points(:)
    type(state_variable_t), intent(in) :: variables(:)
    type(transfer_options_t), intent(in) :: options
    real(wp), intent(in) :: lower(:, :), upper(:, :)   !! (new point of all, component), of the sources
    real(wp), intent(in) :: before(:, :)
    real(wp), intent(inout) :: after(:, :)
    type(transfer_report_t), intent(inout) :: report
    ! (point, component) here: each component is treated alone
    real(wp) :: old(size(old_points), size(before, 1)), new(size(new_points), size(before, 1))
    real(wp) :: old_volumes(size(old_points)), new_volumes(size(new_points))
    type(carried_quantity_t) :: rows(size(before, 1))
    logical :: is_fraction(size(before, 1))
    integer :: i, k

    old = transpose(before(:, old_points))
    new = transpose(after(:, new_points))
    old_volumes = from%volumes(old_points)
    new_volumes = to%volumes(new_points)
    call start_rows(variables, m, old_volumes, new_volumes, old, new, rows)
    do i = 1, size(variables)
      if (variables(i)%transfer /= transfer_scalar .or. options%limit == limit_none) cycle
      do k = variables(i)%first, variables(i)%first + variables(i)%ncomp - 1
        call clip(new_volumes, max(rows(k)%least_before, lower(new_points, k)), &
                  min(rows(k)%largest_before, upper(new_points, k)), new(:, k), rows(k)%clipped)
      end do
    end do
    call find_fractions(variables, old, is_fraction)
    associate (fractional => pack([(k, k=1, size(rows))], is_fraction))
      if (size(fractional) > 0) call treat_fractions(old(:, fractional), new_volumes, fractional, new, rows)
      rows%limited = [(integral(new(:, k), new_volumes), k=1, size(rows))]
      if (options%conserve) call conserve_means(variables, fractional, old, old_volumes, new_volumes, rows, new)
    end associate
    rows%after = [(integral(new(:, k), new_volumes), k=1, size(rows))]
    rows%least_after = minval(new, 1)
    rows%largest_after = maxval(new, 1)
    after(:, new_points) = transpose(new)
    call add_rows(pack(rows, any(abs(old) > 0, 1)), report%rows)
  end subroutine treat_material

  !> Names, old and carried integrals, old ranges.
  pure subroutine start_rows(variables, material, old_volumes, new_volumes, old, new, rows)
    type(state_variable_t), intent(in) :: variables(:)
    integer, intent(in) :: material
    real(wp), intent(in) :: old_volumes(:), new_volumes(:), old(:, :), new(:, :)
    type(carried_quantity_t), intent(out) :: rows(:)
    type(string_t), allocatable :: names(:)
    integer :: i, k

    call component_names(variables, names)
    do i = 1, size(variables)
      do k = variables(i)%first, variables(i)%first + variables(i)%ncomp - 1
        rows(k)%name = names(k)%s
        rows(k)%unit = variables(i)%unit
        rows(k)%transfer = variables(i)%transfer
        rows(k)%material = material
        rows(k)%before = integral(old(:, k), old_volumes)
        rows(k)%magnitude = integral(abs(old(:, k)), old_volumes)
        rows(k)%carried = integral(new(:, k), new_volumes)
        rows(k)%least_before = minval(old(:, k))
        rows(k)%largest_before = maxval(old(:, k))
      end do
    end do
  end subroutine start_rows

  !> Components that are fractions of this material: those not zero all over it.
  pure subroutine find_fractions(variables, old, is_fraction)
    type(state_variable_t), intent(in) :: variables(:)
    real(wp), intent(in) :: old(:, :)
    logical, intent(out) :: is_fraction(:)
    integer :: i, k

    is_fraction = .false.
    do i = 1, size(variables)
      if (variables(i)%transfer /= transfer_fraction) cycle
      do k = variables(i)%first, variables(i)%first + variables(i)%ncomp - 1
        is_fraction(k) = any(abs(old(:, k)) > 0)
      end do
    end do
  end subroutine find_fractions

  !> Fractions between 0 and 1, their sums as they were.
  pure subroutine treat_fractions(old, volumes, fractional, new, rows)
    real(wp), intent(in) :: old(:, :), volumes(:)   !! old fractions only
    integer, intent(in) :: fractional(:)
    real(wp), intent(inout) :: new(:, :)
    type(carried_quantity_t), intent(inout) :: rows(:)
    real(wp) :: fractions(size(fractional))
    integer :: rule, p, k

    rule = fractions_rule(transpose(old))
    do k = 1, size(fractional)
      rows(fractional(k))%clipped = sum(volumes, mask=new(:, fractional(k)) < 0 .or. new(:, fractional(k)) > 1)/sum(volumes)
    end do
    do p = 1, size(new, 1)
      fractions = new(p, fractional)
      call keep_fractions(rule, fractions)
      new(p, fractional) = fractions
    end do
  end subroutine treat_fractions

  !> Means of scalars within the range of the material, and of fractions, as in the old mesh.
  pure subroutine conserve_means(variables, fractional, old, old_volumes, new_volumes, rows, new)
    type(state_variable_t), intent(in) :: variables(:)
    integer, intent(in) :: fractional(:)
    real(wp), intent(in) :: old(:, :), old_volumes(:), new_volumes(:)
    type(carried_quantity_t), intent(in) :: rows(:)
    real(wp), intent(inout) :: new(:, :)
    real(wp) :: growth
    real(wp) :: fractions(size(fractional), size(new, 1))
    integer :: i, k

    growth = sum(new_volumes)/sum(old_volumes)
    do i = 1, size(variables)
      if (variables(i)%transfer /= transfer_scalar) cycle
      do k = variables(i)%first, variables(i)%first + variables(i)%ncomp - 1
        call keep_mean(new_volumes, min(rows(k)%least_before, minval(new(:, k))), &
                       max(rows(k)%largest_before, maxval(new(:, k))), rows(k)%before*growth, new(:, k))
      end do
    end do
    if (size(fractional) == 0) return
    if (fractions_rule(transpose(old(:, fractional))) == sum_is_one) then
      fractions = transpose(new(:, fractional))
      call keep_mean_fractions(new_volumes, rows(fractional)%before*growth, fractions)
      new(:, fractional) = transpose(fractions)
    else
      do i = 1, size(fractional)
        call keep_mean(new_volumes, 0.0_wp, 1.0_wp, rows(fractional(i))%before*growth, new(:, fractional(i)))
      end do
    end if
  end subroutine conserve_means

  pure subroutine add_rows(more, rows)
    type(carried_quantity_t), intent(in) :: more(:)
    type(carried_quantity_t), allocatable, intent(inout) :: rows(:)
    type(carried_quantity_t), allocatable :: all_rows(:)
    integer :: n

    n = size(rows)
    allocate (all_rows(n + size(more)))
    all_rows(:n) = rows
    all_rows(n + 1:) = more
    call move_alloc(all_rows, rows)
  end subroutine add_rows

end module transfer_treatment
