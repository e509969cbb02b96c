// Everything in its order, and the face for scripts.
document.querySelector('.pair').classList.toggle('two', !several && !!byId('mechanism'));
startTheme();
startTop();
startSide();
startFacts();
startClock();
startScene();
startCards('orbits', 'orbits', 'orbit', orbitCard);
startCards('bearing', 'bearing', 'polar', bearingCard);
startFigures();
startImpacts();
startModel();
startPlots();
startKeys();
startFilm();
onTime(() => drawCards(false));
show(timeStart);
window.freeplay = {ready: Promise.resolve(true), seek, play, pause, time: () => clock.time, zoom, range: () => [...clock.range], select,
                   drawn: () => clock.drawn, value: (run, channel) => runs[run].value(channel, clock.time)};
document.body.dataset.ready = '1';
