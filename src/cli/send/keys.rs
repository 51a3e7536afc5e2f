//! Single keys from a terminal, which is set back at the end, whatever the end is.

#[cfg(unix)]
pub(super) use unix::{Keys, pause_is_asked_for};

#[cfg(not(unix))]
pub(super) use waiting::{Keys, pause_is_asked_for};

#[cfg(unix)]
mod unix {
    use crate::cli::interruption::at_last;
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::io::read;
    use rustix::stdio::stdin;
    use rustix::termios::{LocalModes, OptionalActions, Termios, isatty, tcgetattr, tcsetattr};
    use signal_hook::consts::SIGUSR1;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::{Arc, LazyLock, Mutex, PoisonError};

    /// The terminal's settings before keys were read.
    static BEFORE: Mutex<Option<Termios>> = Mutex::new(None);
    static PAUSE: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| {
        let flag = Arc::new(AtomicBool::new(false));
        // Without the handler the signal ends the process, which a script would notice.
        let _ = signal_hook::flag::register(SIGUSR1, Arc::clone(&flag));
        flag
    });

    /// True once for each signal that asks for a pause.
    pub(in crate::cli::send) fn pause_is_asked_for() -> bool {
        PAUSE.swap(false, Ordering::SeqCst)
    }

    /// Sets the terminal back.
    fn restore_terminal() {
        if let Some(before) = BEFORE.lock().unwrap_or_else(PoisonError::into_inner).take() {
            let _ = tcsetattr(stdin(), OptionalActions::Now, &before);
        }
    }

    /// A terminal that gives single keys, without showing them.
    pub(in crate::cli::send) struct Keys;

    impl Keys {
        /// The terminal on stdin, if it is one.
        pub fn of_terminal() -> Option<Self> {
            let _ = pause_is_asked_for();
            if !isatty(stdin()) {
                return None;
            }
            let before = tcgetattr(stdin()).ok()?;
            let mut now = before.clone();
            now.local_modes.remove(LocalModes::ICANON | LocalModes::ECHO);
            tcsetattr(stdin(), OptionalActions::Now, &now).ok()?;
            at_last(restore_terminal);
            *BEFORE.lock().unwrap_or_else(PoisonError::into_inner) = Some(before);
            Some(Self)
        }

        /// The next key, if one was pressed.
        pub fn pressed() -> Option<u8> {
            let (input_end, now) = (stdin(), Timespec { tv_sec: 0, tv_nsec: 0 });
            let mut waiting = [PollFd::new(&input_end, PollFlags::IN)];
            if poll(&mut waiting, Some(&now)).ok()? == 0 {
                return None;
            }
            let mut key = [0];
            // Not by the buffer of the standard library: keys that it holds would not be seen here.
            (read(input_end, &mut key).ok()? == 1).then_some(key[0])
        }
    }

    impl Drop for Keys {
        fn drop(&mut self) {
            restore_terminal();
        }
    }
}

/// Systems without terminal modes of Unix: a thread waits for keys of the console.
#[cfg(not(unix))]
mod waiting {
    use console::{Key, Term};
    use std::io::IsTerminal;
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::sync::{LazyLock, Mutex, PoisonError};

    /// Keys that were pressed and not yet looked at.
    static PRESSED: LazyLock<Mutex<Receiver<u8>>> = LazyLock::new(|| {
        let (sender, receiver) = channel();
        std::thread::spawn(move || wait(&sender));
        Mutex::new(receiver)
    });

    /// Passes keys on until the console is gone.
    fn wait(sender: &Sender<u8>) {
        let console = Term::stdout();
        while let Ok(key) = console.read_key() {
            let key = match key {
                Key::Char(letter) => u8::try_from(letter).ok(),
                Key::Enter => Some(b'\n'),
                Key::CtrlC => Some(b'q'),
                _ => None,
            };
            if key.is_some_and(|key| sender.send(key).is_err()) {
                return;
            }
        }
    }

    /// There is no signal for that.
    pub(in crate::cli::send) fn pause_is_asked_for() -> bool {
        false
    }

    /// A console that gives single keys, without showing them.
    pub(in crate::cli::send) struct Keys;

    impl Keys {
        /// The console on stdin, if it is one.
        pub fn of_terminal() -> Option<Self> {
            if !std::io::stdin().is_terminal() {
                return None;
            }
            LazyLock::force(&PRESSED);
            Some(Self)
        }

        /// The next key, if one was pressed.
        pub fn pressed() -> Option<u8> {
            PRESSED.lock().unwrap_or_else(PoisonError::into_inner).try_recv().ok()
        }
    }
}
