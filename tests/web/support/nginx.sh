# shellcheck shell=bash
# The proxy of the page's tests; part of ../../../dev, whose functions it uses.

# Unpacks the proxy of the tests. Installed, Debian's package would start a web server on port 80, now
# and each time that the machine starts.
unpack_nginx() {
  local folder="$root/.tools/nginx"
  [[ ! -x "$folder/usr/sbin/nginx" ]] || return 0
  if ! command -v dpkg-deb >/dev/null; then
    say "dev: this is not Debian, so nginx is not unpacked; needed is $folder/usr/sbin/nginx"
    return
  fi
  say "dev: unpacking nginx"
  rm -rf -- "$folder" && mkdir -p "$folder"
  apt_knows nginx || apt_get update
  (
    cd "$folder" &&
      { apt-get --quiet download nginx || { apt_get update && apt-get --quiet download nginx; }; } &&
      dpkg-deb --extract nginx_*.deb . && rm -f -- nginx_*.deb
  ) >&2 || die "cannot unpack nginx"
}
