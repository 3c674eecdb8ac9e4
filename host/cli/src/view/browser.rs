//! Browsers: the user's own, and one without a window that draws a picture.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::{env, fs, io, process};

/// Names under which Chromium goes, best first.
const NAMES: &[&str] =
    &["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "microsoft-edge"];

/// Without a window, a graphics card, a profile of its own or a wish to speak to anyone.
const QUIETLY: &[&str] = &[
    "--headless",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-quic",
    "--disable-sync",
    "--disable-extensions",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--no-first-run",
    "--no-default-browser-check",
    "--force-device-scale-factor=1",
    "--remote-debugging-port=0",
];

/// Opens an address in the user's browser; `false` where there is none to open.
pub(super) fn open(address: &str) -> bool {
    let (program, before): (_, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("cmd", &["/C", "start", ""])
    } else if env::var_os("DISPLAY").is_some() || env::var_os("WAYLAND_DISPLAY").is_some() {
        ("xdg-open", &[])
    } else {
        // Without a screen it would open a browser in the terminal.
        return false;
    };
    let mut command = Command::new(program);
    command.args(before).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// The first Chromium on the PATH.
pub(super) fn find() -> Option<PathBuf> {
    NAMES.iter().find_map(|name| named(Path::new(name)))
}

/// A program: where it is told to be, or else a name on the PATH.
pub(super) fn named(program: &Path) -> Option<PathBuf> {
    if program.components().count() > 1 {
        return Some(program.to_owned()).filter(|place| place.is_file());
    }
    let path = env::var_os("PATH")?;
    let mut places = env::split_paths(&path).map(|folder| folder.join(program));
    places.find_map(|place| {
        let whole = place.with_extension(env::consts::EXE_EXTENSION);
        if whole.is_file() { Some(whole) } else { Some(place).filter(|place| place.is_file()) }
    })
}

/// A browser without a window, and a profile that is gone with it.
pub(super) struct Unseen {
    child: Child,
    profile: PathBuf,
}

impl Unseen {
    /// Opens an address in a window of a size that nobody sees.
    ///
    /// # Errors
    /// The program can't be started.
    pub(super) fn open(program: &Path, address: &str, [width, height]: [u32; 2]) -> io::Result<Self> {
        let profile = env::temp_dir().join(format!("zygote-view-{}", process::id()));
        fs::create_dir_all(&profile)?;
        let mut command = Command::new(program);
        command.args(QUIETLY).arg(format!("--window-size={width},{height}"));
        command.arg(format!("--user-data-dir={}", profile.display()));
        if is_root() {
            // Chromium refuses its sandbox to root; the page is ours, and asks nothing of the network.
            command.arg("--no-sandbox");
        }
        command.arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        match command.spawn() {
            Ok(child) => Ok(Self { child, profile }),
            Err(error) => {
                fs::remove_dir_all(&profile).ok();
                Err(error)
            }
        }
    }

    /// How it ended, if it did.
    pub(super) fn ended(&mut self) -> Option<String> {
        self.child.try_wait().ok().flatten().map(|status| status.to_string())
    }
}

impl Drop for Unseen {
    fn drop(&mut self) {
        // What is left of it afterwards is nobody's loss: a process that ended, files in the folder for temporary ones.
        self.child.kill().ok();
        self.child.wait().ok();
        for _ in 0..20 {
            // Its helpers may still write.
            if fs::remove_dir_all(&self.profile).is_ok() || !self.profile.exists() {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(50));
        }
    }
}

#[cfg(target_os = "linux")]
fn is_root() -> bool {
    use std::os::unix::fs::MetadataExt;
    fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0)
}

#[cfg(not(target_os = "linux"))]
fn is_root() -> bool {
    false
}
