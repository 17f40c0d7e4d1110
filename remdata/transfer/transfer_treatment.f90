!> Treatment of values after their transfer: ranges, sums of fractions, means, and the report of the changes.
module transfer_treatment
  use kinds, only: wp
  use state_variables, only: component_names, state_variable_t, transfer_fraction, transfer_scalar
  use text, only: add_text, string_t
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
    type(string_t), allocatable :: formulations(:)
    integer, allocatable :: fractional(:)
    real(wp) :: growth
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
    call list_formulations(variables, formulations)
    do i = 1, size(formulations)
      fractional = fractions_of(variables, formulations(i)%s, old)
      if (size(fractional) > 0) call treat_fractions(old(:, fractional), new_volumes, fractional, new, rows)
    end do
    rows%limited = [(integral(new(:, k), new_volumes), k=1, size(rows))]
    ! means of the whole are none of what a cut has left
    if (options%conserve .and. .not. options%was_cut(m)) then
      growth = sum(new_volumes)/sum(old_volumes)
      call conserve_scalars(variables, growth, new_volumes, rows, new)
      do i = 1, size(formulations)
        fractional = fractions_of(variables, formulations(i)%s, old)
        if (size(fractional) > 0) call conserve_fractions(fractional, growth, old, new_volumes, rows, new)
      end do
    end if
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

  !> Formulations on the points that have fractions, by what comes before the names of their variables (state_pieces): the sum of
  !> each one's fractions is 1 by itself.
  pure subroutine list_formulations(variables, list)
    type(state_variable_t), intent(in) :: variables(:)
    type(string_t), allocatable, intent(out) :: list(:)   !! (nformulation)
    integer :: i, k

    allocate (list(0))
    next: do i = 1, size(variables)
      if (variables(i)%transfer /= transfer_fraction) cycle next
      do k = 1, size(list)
        if (list(k)%s == formulation_of(variables(i))) cycle next
      end do
      call add_text(list, formulation_of(variables(i)))
    end do next
  end subroutine list_formulations

  !> What comes before the name of a variable, nothing for those of the first formulation.
  pure function formulation_of(variable) result(name)
    type(state_variable_t), intent(in) :: variable
    character(len=:), allocatable :: name

    name = variable%name(:index(variable%name, ' ', back=.true.))
  end function formulation_of

  !> Components that are fractions of this material in a formulation: those not zero all over it.
  pure function fractions_of(variables, formulation, old) result(components)
    type(state_variable_t), intent(in) :: variables(:)
    character(len=*), intent(in) :: formulation
    real(wp), intent(in) :: old(:, :)   !! (point, component) [unit of each component]
    integer, allocatable :: components(:)
    integer :: i, k

    allocate (components(0))
    do i = 1, size(variables)
      if (variables(i)%transfer /= transfer_fraction .or. formulation_of(variables(i)) /= formulation) cycle
      do k = variables(i)%first, variables(i)%first + variables(i)%ncomp - 1
        if (any(abs(old(:, k)) > 0)) components = [components, k]
      end do
    end do
  end function fractions_of

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

  !> Means of scalars as in the old mesh, within the range of the material.
  pure subroutine conserve_scalars(variables, growth, volumes, rows, new)
    type(state_variable_t), intent(in) :: variables(:)
    real(wp), intent(in) :: growth                      !! of the volume of the material [-]
    real(wp), intent(in) :: volumes(:)                  !! (npoint) of the new mesh [volume]
    type(carried_quantity_t), intent(in) :: rows(:)     !! (component)
    real(wp), intent(inout) :: new(:, :)                !! (point, component) [unit of each component]
    integer :: i, k

    do i = 1, size(variables)
      if (variables(i)%transfer /= transfer_scalar) cycle
      do k = variables(i)%first, variables(i)%first + variables(i)%ncomp - 1
        call keep_mean(volumes, min(rows(k)%least_before, minval(new(:, k))), max(rows(k)%largest_before, maxval(new(:, k))), &
                       rows(k)%before*growth, new(:, k))
      end do
    end do
  end subroutine conserve_scalars

  !> Means of the fractions of a formulation as in the old mesh.
  pure subroutine conserve_fractions(fractional, growth, old, volumes, rows, new)
    integer, intent(in) :: fractional(:)                !! (nfraction) components
    real(wp), intent(in) :: growth                      !! of the volume of the material [-]
    real(wp), intent(in) :: old(:, :)                   !! (point, component) of the old mesh [unit of each component]
    real(wp), intent(in) :: volumes(:)                  !! (npoint) of the new mesh [volume]
    type(carried_quantity_t), intent(in) :: rows(:)     !! (component)
    real(wp), intent(inout) :: new(:, :)                !! (point, component) [unit of each component]
    real(wp) :: fractions(size(fractional), size(new, 1))
    integer :: i

    if (fractions_rule(transpose(old(:, fractional))) == sum_is_one) then
      fractions = transpose(new(:, fractional))
      call keep_mean_fractions(volumes, rows(fractional)%before*growth, fractions)
      new(:, fractional) = transpose(fractions)
    else
      do i = 1, size(fractional)
        call keep_mean(volumes, 0.0_wp, 1.0_wp, rows(fractional(i))%before*growth, new(:, fractional(i)))
      end do
    end if
  end subroutine conserve_fractions

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
