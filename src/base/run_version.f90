!> The version all programs carry.
module run_version
  implicit none
  private
  public :: version_text

  character(len=*), parameter :: version_text = '0.1.0'
end module run_version
